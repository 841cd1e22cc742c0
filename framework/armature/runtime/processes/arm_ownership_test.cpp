// SPDX-License-Identifier: Apache-2.0
// Who drives an arm is its only owner, and others are told who that is.
#include "armature/runtime/processes/arm_ownership.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "armature/config/document.hpp"
#include "armature/values/temporary_folder.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

const std::string kOwner = "pid " + std::to_string(getpid());

class ArmOwnership : public testing::Test {
 protected:
  /// A deployment with one arm in `process`.
  DeploymentConfig driving(const PluginManifest& plugin, const std::string& device,
                           const std::string& process = "main") {
    config::Problems problems;
    const auto given = config::parse_text("{port: '" + device + "'}", "test");
    DeploymentConfig deployment;
    deployment.name = "ownership_" + std::to_string(getpid()) + "_" + std::to_string(++made_);
    deployment.components.push_back(
        {.name = "arm",
         .manifest = &plugin,
         .params = Params::read(plugin.params, &given, plugin.id, problems),
         .process = process});
    problems.throw_if_any();
    return deployment;
  }

  static std::string refusal(const DeploymentConfig& deployment, int domain = 1,
                             const std::string& process = "main") {
    return test::refusal_of([&] { own_arms(deployment, process, domain); });
  }

  static PluginManifest plugin(const std::string& driver) {
    return parse_own_manifest("armature_plugin: 1\nid: arm/test_" + std::to_string(getpid()) +
                              "\nkind: component\nparams: {port: {type: text}}\ndriver: {" +
                              driver + "}\n");
  }

  const PluginManifest metal_ = plugin("device: port"), nameless_ = plugin(""),
                       simulated_ = plugin("simulated: true");
  const TemporaryFolder folder_;
  const std::string port_ = folder_ / "port";

 private:
  int made_ = 0;
};

TEST_F(ArmOwnership, TwoDeploymentsDoNotDriveOneDevice) {
  const auto owned = own_arms(driving(metal_, port_), "main", 1);
  EXPECT_EQ(refusal(driving(metal_, port_), 2),
            "the arm at '" + port_ + "' is driven by " + kOwner + " already; stop it first");
  EXPECT_EQ(refusal(driving(metal_, port_ + "0")), "");
}

TEST_F(ArmOwnership, ADeviceIsTheSameUnderEveryName) {
  const std::string other = port_ + "-by-id";
  std::ofstream{port_} << "";
  std::filesystem::create_symlink(port_, other);
  const auto owned = own_arms(driving(metal_, port_), "main", 1);
  EXPECT_EQ(refusal(driving(metal_, other)),
            "the arm at '" + other + "' is driven by " + kOwner + " already; stop it first");
}

TEST_F(ArmOwnership, ADriverThatNamesNoDeviceDrivesTheOnlyArmOfItsKind) {
  const auto owned = own_arms(driving(nameless_, "a"), "main", 1);
  EXPECT_EQ(refusal(driving(nameless_, "b")),
            "the arm of '" + nameless_.id + "' is driven by " + kOwner + " already; stop it first");
}

TEST_F(ArmOwnership, TheProcessThatDrivesOwnsAndTheMainOneLooksFirst) {
  const auto split = driving(metal_, port_, "aside");
  const auto main_locks = own_arms(split, "main", 1);
  const auto owned = own_arms(split, "aside", 1);
  EXPECT_EQ(owned.size(), 2U) << "its name in the deployment, and the device";
  EXPECT_EQ(refusal(driving(metal_, port_, "aside")),
            "the arm at '" + port_ + "' is driven by " + kOwner + " already; stop it first");
}

TEST_F(ArmOwnership, EveryProcessOfADeploymentIsThereOnceOnADomain) {
  const auto split = driving(simulated_, port_, "aside");
  const auto main_locks = own_arms(split, "main", 1);
  const auto owned = own_arms(split, "aside", 1);
  EXPECT_EQ(refusal(split, 1, "aside"),
            "process 'aside' of deployment '" + split.name + "' already runs as " + kOwner +
                " on domain 1; stop it, or use another domain with --domain");
  EXPECT_EQ(refusal(split, 2, "aside"), "");
  EXPECT_EQ(refusal(split, 1, "control"), "");
}

TEST_F(ArmOwnership, TwoComponentsOfADeploymentDoNotDriveOneDevice) {
  auto deployment = driving(metal_, port_);
  deployment.components.push_back(deployment.components.front());
  EXPECT_EQ(refusal(deployment),
            "two components drive the arm at '" + port_ + "'; give each a device of its own");
}

TEST_F(ArmOwnership, TwoHostsHaveADeviceOfTheSameNameEach) {
  auto deployment = driving(metal_, port_);
  deployment.components.push_back(deployment.components.front());
  deployment.components.back().process = "aside";
  deployment.components.back().host = "desk";
  EXPECT_EQ(refusal(deployment), "");
  EXPECT_EQ(refusal(deployment, 1, "aside"), "");
}

TEST_F(ArmOwnership, ASimulatedArmIsItsDeploymentsOnEveryDomain) {
  const auto deployment = driving(simulated_, port_);
  const auto owned = own_arms(deployment, "main", 1);
  EXPECT_EQ(refusal(deployment), "deployment '" + deployment.name + "' already runs as " + kOwner +
                                     " on domain 1; stop it, or use another domain with --domain");
  EXPECT_EQ(refusal(deployment, 2), "");
  EXPECT_EQ(refusal(driving(simulated_, port_)), "");
}

}  // namespace
}  // namespace armature
