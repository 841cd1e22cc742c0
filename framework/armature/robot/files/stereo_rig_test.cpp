// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/stereo_rig.hpp"

#include <gmock/gmock.h>

#include <random>

#include "armature/config/document.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;

StereoRig rig(const std::string& name) {
  return load_stereo_rig(std::filesystem::path{ARMATURE_SOURCE_DIR} / "configs/rigs" /
                         (name + ".yaml"));
}

std::vector<std::string> problems_of(const std::string& text) {
  return test::problems_of([&] { read_stereo_rig(config::parse_text(text, "rig.yaml")); });
}

TEST(StereoRig, DefaultSeesSeventyDegreesAcrossItsImage) {
  const StereoRig head = rig("default");
  EXPECT_EQ(head.camera.width, 1280);
  EXPECT_EQ(head.camera.height, 720);
  EXPECT_EQ(head.camera.baseline_m, 0.12);
  EXPECT_EQ(head.camera.cx, 639.5);
  EXPECT_EQ(head.camera.cy, 359.5);
  EXPECT_NEAR(2 * std::atan(640 / head.camera.focal_px), 70 * M_PI / 180, 1e-12);
  EXPECT_EQ(head.mounted_on, "tool");
}

TEST(StereoRig, LooksAlongToolXWithImageRightAlongToolZ) {
  const StereoRig head = rig("default");
  const Eigen::Matrix3d tool_R_left = head.mount_T_left.linear();
  EXPECT_TRUE(tool_R_left.col(0) == Vector3d::UnitZ());
  EXPECT_TRUE(tool_R_left.col(1) == -Vector3d::UnitY());
  EXPECT_TRUE(tool_R_left.col(2) == Vector3d::UnitX());
  EXPECT_EQ(tool_R_left.determinant(), 1);
  EXPECT_TRUE(head.mount_T_left.translation().isApprox(Vector3d{0, 0, -0.06}));
}

TEST(StereoRig, OfThePaperGivesThePapersCoordinates) {
  const StereoRig head = rig("paper");
  const auto seen = [&](double ul, double vl, double ur, double vr) {
    return Vector3d{head.mount_T_left * head.camera.triangulate({ul, vl}, {ur, vr}) * 1000};
  };
  EXPECT_LT((seen(438, 353, 400, 353) - Vector3d{497.3062578, 92.8421053, -51.1578947}).norm(),
            1e-6);
  EXPECT_LT((seen(603, 351, 565, 350) - Vector3d{497.3062578, 94.4210526, 53.0526316}).norm(),
            1e-6);
  EXPECT_LT((seen(523, 498, 484, 498) - Vector3d{484.5548153, 1.2307692, 2.1538462}).norm(), 1e-6);
}

TEST(StereoRig, TriangulatesWhatItProjects) {
  const StereoCamera camera = rig("default").camera;
  std::mt19937 random{71};
  std::uniform_real_distribution<double> across{-0.3, 0.3}, depth{0.3, 2};
  for (int n = 0; n < 1000; ++n) {
    const Vector3d point{across(random), across(random), depth(random)};
    const Vector3d again =
        camera.triangulate(camera.project_left(point), camera.project_right(point));
    ASSERT_LT((again - point).norm(), 1e-11) << "seed 71";
  }
}

TEST(StereoRig, FileReportsEverythingThatIsWrongAtOnce) {
  EXPECT_THAT(
      problems_of("armature_rig: 1\n"
                  "name: bad\n"
                  "resolution: [1280.5, 720]\n"
                  "fov_deg: 70\n"
                  "focal_px: -3\n"
                  "baseline_mm: 0\n"
                  "mount: {frame: tool, forward: [1, 0, 0], right: [1, 0, 1], centre_mm: 3}\n"),
      ElementsAre("rig.yaml:3:13: 'resolution' is [width, height] in whole pixels, not 1280.5",
                  "rig.yaml:5:11: 'focal_px' is -3, must be more than 0",
                  "rig.yaml:5:11: 'fov_deg' and 'focal_px' state the same; keep one",
                  "rig.yaml:6:14: 'baseline_mm' is 0, must be more than 0",
                  "rig.yaml:7:49: 'right' must be square to 'forward'; they are 45.0 "
                  "degrees apart",
                  "rig.yaml:7:60: unknown key 'centre_mm' in mount; did you mean 'center_mm'?"));
  EXPECT_THAT(problems_of("{armature_rig: 1, name: bare}"),
              ElementsAre("rig.yaml:1:1: missing key 'resolution' in rig",
                          "rig.yaml:1:1: missing key 'fov_deg' in rig; or state 'focal_px'",
                          "rig.yaml:1:1: missing key 'baseline_mm' in rig",
                          "rig.yaml:1:1: missing key 'mount' in rig"));
}

}  // namespace
}  // namespace armature
