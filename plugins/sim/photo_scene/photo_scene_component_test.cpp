// SPDX-License-Identifier: Apache-2.0
// The scene on its topics: 1. what it publishes, when, and with which stamps, 2. capture and light,
// 3. an arm that tells nonsense. Rendering itself is tested beside it.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "armature/kinds/target/target_messages.hpp"
#include "photo_scene_harness_test.hpp"

namespace armature::sim::photo_scene {
namespace {

using Eigen::Vector3d;

class PhotoSceneComponentTest : public testing::Test {
 protected:
  void arm_at(double stamp_s) {
    msg::JointState arm;
    write_all_joints(lamp_, resting_position(lamp_), JointVector::Zero(5),
                     Time{} + seconds(stamp_s), arm);
    scene_.send("measured_js", arm);
  }
  std::vector<msg::Image> pictures() { return scene_.take<msg::Image>("left_image"); }
  /// The one picture of an arm at `t_s`.
  msg::Image picture(double t_s) {
    arm_at(t_s);
    scene_.step(t_s);
    const auto taken = pictures();
    EXPECT_EQ(taken.size(), 1u);
    return taken.empty() ? msg::Image{} : taken.front();
  }

  const RobotModel lamp_ = load_robot_model(kLamp);
  ComponentHarness scene_{built_plugins(), scene_with("noise: 0, move_at_s: 1, move_duration_s: 2, "
                                                      "move_mm: [0, 100, 0]")};
};

TEST_F(PhotoSceneComponentTest, RunsAtItsRate) {
  EXPECT_EQ(scene_.period(), seconds(0.1));
  const ComponentHarness fast{built_plugins(), scene_with("rate_hz: 25")};
  EXPECT_EQ(fast.period(), seconds(0.04));
}

TEST_F(PhotoSceneComponentTest, TellsTheTruthOnEveryStepAlsoWithoutAnArm) {
  for (const double t : {10.0, 10.5, 12.0, 20.0}) {
    scene_.step(t);
    const auto truth = scene_.take<msg::Target>("truth");
    ASSERT_EQ(truth.size(), 1u);
    const auto told = estimate_of(truth[0]);
    ASSERT_TRUE(told) << told.error().text;
    EXPECT_EQ(told->stamp, Time{} + seconds(t));
    const double moved = t < 11 ? 0 : t > 13 ? 0.1 : 0.05;  // it starts 1 s after the first step
    EXPECT_LE((told->position - Vector3d{1.55, moved, 0.45}).norm(), 1e-9);
    EXPECT_LE((told->normal - Vector3d{-1, 0, 0}).norm(), 1e-12);
    EXPECT_NEAR(told->velocity.y(), t == 12 ? 1.875 * 0.05 : 0, 1e-9);
  }
  EXPECT_TRUE(pictures().empty());
}

TEST_F(PhotoSceneComponentTest, TakesAPairOfPicturesStampedAsTheArmAndOnePerSampleOfIt) {
  arm_at(9.998);
  scene_.step(10);
  const auto left = pictures(), right = scene_.take<msg::Image>("right_image");
  ASSERT_TRUE(left.size() == 1 && right.size() == 1);
  for (const auto& image : {left[0], right[0]}) {
    EXPECT_EQ(stamp_of(image.header_().stamp_()), Time{} + seconds(9.998));
    EXPECT_EQ(image.header_().frame_id_(), "left_camera_optical");
    EXPECT_EQ(image.encoding_(), "mono8");
    EXPECT_EQ(image.width_(), 160u);
    EXPECT_EQ(image.height_(), 90u);
    EXPECT_EQ(image.step_(), 160u);
    EXPECT_EQ(image.data_().size(), 160u * 90u);
  }
  scene_.step(10.1);
  EXPECT_TRUE(pictures().empty()) << "the arm has not moved on";
  arm_at(10.2);
  scene_.step(10.2);
  EXPECT_EQ(pictures().size(), 1u);
}

TEST_F(PhotoSceneComponentTest, TellsTheCamerasOnceWithTheFirstPicture) {
  scene_.step(9);
  EXPECT_TRUE(scene_.take<msg::CameraInfo>("left_info").empty());
  picture(10);
  picture(10.1);
  const auto left = scene_.take<msg::CameraInfo>("left_info");
  const auto right = scene_.take<msg::CameraInfo>("right_info");
  ASSERT_TRUE(left.size() == 1 && right.size() == 1);
  const double f = 80 / std::tan(35 * M_PI / 180);
  EXPECT_EQ(left[0].width_(), 160u);
  EXPECT_NEAR(left[0].k_()[0], f, 1e-9);
  EXPECT_EQ(left[0].p_()[3], 0);
  EXPECT_NEAR(right[0].p_()[3], -f * 0.12, 1e-9);
  EXPECT_EQ(stamp_of(right[0].header_().stamp_()), Time{} + seconds(10));
}

TEST_F(PhotoSceneComponentTest, TakesNoPicturesWhileCaptureIsOff) {
  msg::Capture capture;
  capture.on_(false);
  scene_.send("capture", capture);
  arm_at(10);
  scene_.step(10);
  EXPECT_TRUE(pictures().empty());
  EXPECT_EQ(scene_.take<msg::Target>("truth").size(), 1u);
  capture.on_(true);
  scene_.send("capture", capture);
  picture(10.1);
}

TEST_F(PhotoSceneComponentTest, TheLampsLightBrightensThePicture) {
  const double dark = mean(picture(10));
  msg::LightLevel level;
  level.level_(0.2);
  scene_.send("light_level", level);
  EXPECT_NEAR(mean(picture(10.1)) / dark, 1 + 3 * 0.2, 0.01);
  level.level_(-5);
  scene_.send("light_level", level);
  EXPECT_NEAR(mean(picture(10.2)), dark, 1e-9);
}

TEST_F(PhotoSceneComponentTest, IsDegradedByAJointStateThatIsNoneUntilAGoodOneComes) {
  const auto trouble = [&](double t_s, const std::vector<double>& position) {
    msg::JointState bad;
    write_header(bad.header_(), Time{} + seconds(t_s), kBaseFrame);
    bad.position_(position);
    scene_.send("measured_js", bad);
    scene_.step(t_s);
    EXPECT_TRUE(pictures().empty());
    EXPECT_EQ(scene_.status().state, StatusReporter::State::degraded);
    return scene_.status().reason;
  };
  EXPECT_EQ(trouble(1, {1, 2}), "measured_js: 2 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(trouble(2, std::vector<double>(99, 0.0)),
            "measured_js: 99 joint values; dental_lamp has 6 joints");
  EXPECT_EQ(trouble(3, {NAN, 0, 0, 0, 0, 0}), "measured_js: j1 = nan is not a number");
  picture(4);
  EXPECT_EQ(scene_.status().state, StatusReporter::State::ok);
}

TEST(PhotoSceneComponent, DoesNotStartWithAFrameOrAPhotoThatIsNotThere) {
  const auto refusal = [](const ComponentHarness::Options& options) {
    return refusal_of(built_plugins(), options);
  };
  ComponentHarness::Options lost = scene_with("");
  lost.rig = small_rig("elbow");
  EXPECT_EQ(refusal(lost),
            "the rig 'small' is mounted on 'elbow', which is no frame of the robot 'dental_lamp'; "
            "known: tool");
  EXPECT_EQ(refusal(scene_with("photo: astronaut, astronaut_file: /no/such.png")),
            "cannot open the photo /no/such.png: No such file or directory; install the Debian "
            "package python3-imageio, or "
            "set photo: generated");
}

}  // namespace
}  // namespace armature::sim::photo_scene
