// SPDX-License-Identifier: Apache-2.0
// Whatever decides how a deployment moves changes its fingerprint; what does not, does not.
#include "armature/runtime/deployment_file/fingerprint.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "armature/config/document.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

class Fingerprint : public testing::Test {
 protected:
  Fingerprint() {
    write("robot.yaml", "robot: {urdf: arm.urdf, tool: {calibrated: tool.yaml}}\n");
    write("tool.yaml", "length_m: 0.1\n");
    write("arm.urdf", "<robot/>");
    write("photo.png", "a picture");
    write("deployment.yaml", "name: lamp  # of the clinic\nphoto: photo.png\n");
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream{folder_ / name} << text;
  }
  std::string now() const {
    DeploymentConfig deployment;
    deployment.documents["robots"].emplace("arm", config::load(folder_ / "robot.yaml"));
    return fingerprint_of(config::load(folder_ / "deployment.yaml"), deployment);
  }

 private:
  const TemporaryFolder folder_;
};

TEST_F(Fingerprint, IsASha256) {
  EXPECT_EQ(now().size(), 64U);
  EXPECT_EQ(now().find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST_F(Fingerprint, ChangesWithTheFileItsRobotAndTheRobotsCalibration) {
  std::string before = now();
  for (const auto& [file, text] :
       {std::pair{"deployment.yaml", "name: lamp\nphoto: other.png\n"},
        {"robot.yaml", "robot: {arm_m: 1, urdf: arm.urdf, tool: {calibrated: tool.yaml}}"},
        {"arm.urdf", "<robot name='arm'/>"},
        {"tool.yaml", "length_m: 0.2\n"}}) {
    write(file, text);
    EXPECT_NE(now(), before) << file;
    before = now();
  }
}

TEST_F(Fingerprint, DoesNotChangeWithACommentOrAPicture) {
  const std::string before = now();
  write("deployment.yaml", "name: lamp  # of another clinic\nphoto: photo.png\n");
  write("photo.png", "another picture");
  EXPECT_EQ(now(), before);
}

TEST_F(Fingerprint, IsThatOfEveryMachineHoweverItJoinsDds) {
  const std::string before = now();
  write("deployment.yaml",
        "name: lamp\ndds: {interfaces: [enp3s0]}\ndomain: 7\nphoto: photo.png\n");
  EXPECT_EQ(now(), before);
}

}  // namespace
}  // namespace armature
