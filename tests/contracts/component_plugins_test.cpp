// SPDX-License-Identifier: Apache-2.0
// The laws of components, for every component of the build, made with its defaults and a robot and
// rig of configs/: one test each.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "armature/kinds/component/laws.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

/// Entries of components that cannot be made with defaults alone.
std::string entry_of(const PluginManifest& plugin) {
  static const std::map<std::string, std::string> kEntries{
      {"camera/images",
       "{plugin: camera/images, params: {left: " ARMATURE_SOURCE_DIR
       "/docs/figures/lamp, right: " ARMATURE_SOURCE_DIR "/docs/figures/sr1, bad_pictures: skip}}"},
      {"camera/stereo_pair",
       "{plugin: camera/stereo_pair, params: {calibration: " ARMATURE_SOURCE_DIR
       "/configs/cameras/default.yaml}}"},
      {"camera/v4l2", "{plugin: camera/v4l2, params: {device: /dev/null}}"},
      {"host/face_pose", "{plugin: face_pose/three_point}"},
      {"host/ik", "{plugin: ik/numeric}"},
      {"host/landmarks", "{plugin: landmarks/dlib68}"},
      {"host/markers", "{plugin: markers/spheres}"},
      {"host/path", "{plugin: path/mouth_arc}"},
      {"host/registration", "{plugin: registration/rigid}"},
      {"host/select", "{plugin: select/nearest}"},
      {"host/target", "{plugin: target/constant_velocity}"},
      {"host/trajectory", "{plugin: trajectory/quintic_spline}"},
      {"image/volume", "{plugin: image/volume, params: {path: " ARMATURE_SOURCE_DIR "}}"},
      {"motion",
       "{plugin: motion, path: {plugin: path/joint_move}, ik: {plugin: ik/numeric}, select: "
       "{plugin: "
       "select/nearest}, trajectory: {plugin: trajectory/quintic}}"},
      {"operator/pendant", "{plugin: operator/pendant, params: {device: /dev/null}}"},
      {"task/biopsy", "{plugin: task/biopsy, params: {touch_markers: true}}"},
      {"task/waypoints", "{plugin: task/waypoints, params: {positions_mm: [900, 0, 500]}}"},
  };
  const auto found = kEntries.find(plugin.id);
  return found == kEntries.end() ? "{plugin: " + plugin.id + "}" : found->second;
}

/// What a component is made with, or why none of the shipped robots and rigs will do.
struct Made {
  std::optional<ComponentHarness::Options> with;
  std::string refusal;
};

bool uses(const PluginManifest& plugin, std::string_view word) {
  return std::ranges::find(plugin.uses, word) != plugin.uses.end();
}

Made made(const PluginManifest& plugin) {
  const fs::path configs{ARMATURE_SOURCE_DIR "/configs"};
  std::vector<std::string> robots{""}, rigs{""};
  if (uses(plugin, "robot")) {
    robots = {"dental_lamp", "sr1_needle", "med7", "master", "med7_scope"};
  }
  if (uses(plugin, "rig")) rigs = {"default"};
  Made found;
  for (const std::string& robot : robots) {
    for (const std::string& rig : rigs) {
      ComponentHarness::Options options{.component = entry_of(plugin)};
      if (!robot.empty()) options.robot = config::load(configs / "robots" / (robot + ".yaml"));
      if (!rig.empty()) options.rig = config::load(configs / "rigs" / (rig + ".yaml"));
      found.refusal = refusal_of(built_plugins(), options);
      if (found.refusal.empty()) return {options, ""};
    }
  }
  return found;
}

void expect_lawful(const PluginManifest& plugin, const ComponentHarness::Options& options) {
  for (const Law<ComponentSubject>& law : component_laws()) {
    const LawReport report = check_law(
        law,
        ComponentSubject{
            .name = plugin.id,
            .make = [&] { return std::make_unique<ComponentHarness>(built_plugins(), options); },
            .rounds = 50});
    EXPECT_TRUE(report.kept()) << law.name;
    for (const auto& [what, question] : report.violations)
      ADD_FAILURE() << what << "\n" << question;
  }
}

class LawTest : public testing::Test {
 public:
  explicit LawTest(const PluginManifest& plugin) : plugin_{plugin} {}
  void TestBody() override {
    Made found = made(plugin_);
    ASSERT_TRUE(found.with) << found.refusal;
    expect_lawful(plugin_, *found.with);
    for (const UnitSpec& unit : plugin_.units) {
      found.with->unit = unit.name;
      expect_lawful(plugin_, *found.with);
    }
  }

 private:
  const PluginManifest& plugin_;
};

bool add_all_tests() {
  for (const PluginManifest& plugin : built_plugins().plugins()) {
    if (plugin.kind != Component::kKind) continue;
    std::string name = plugin.id;
    std::ranges::replace(name, '/', '_');
    testing::RegisterTest("Components", name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                          [&plugin] { return new LawTest{plugin}; });
  }
  return true;
}
[[maybe_unused]] const bool added = add_all_tests();

}  // namespace
}  // namespace armature
