// SPDX-License-Identifier: Apache-2.0
// The navigation view on its topics: where the tool is in the image, and pictures of that.
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/volume_messages.hpp"
#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/values/temporary_folder.hpp"
#include "armature/volume/nrrd.hpp"
#include "armature/volume/phantom.hpp"

namespace armature::monitor::sections {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

class SectionsComponentTest : public testing::Test {
 protected:
  void show_volume_and_plan() {
    show_volume(0.04);
    show_plan({0, 0, 0.01});
  }
  void show_volume(double radius) {
    VolumeGeometry geometry{.size = {51, 51, 51}, .spacing = Vector3d::Constant(0.002)};
    geometry.origin = Vector3d::Constant(-0.05);
    const Volume volume = scanned(std::array{ball({0, 0, 0}, radius, 35)}, geometry, {});
    ASSERT_TRUE(write_nrrd(volume, folder_ / "volume.nrrd"));
    msg::VolumeFile file;
    file.path_(folder_ / "volume.nrrd");
    file.sha256_(sha256_of(volume));
    view_.send("volume", file);
  }
  void show_plan(const Vector3d& target, double vessel_x = 0.02) {
    msg::NeedlePlan plan;
    assign(plan.entry_(), Vector3d{0, 0, 0.04});
    assign(plan.target_(), target);
    write_zones({{"vessel 1", {vessel_x, -0.01, 0.01}, {vessel_x, 0.01, 0.01}, 0.003}},
                plan.forbidden_());
    view_.send("plan", plan);
  }
  void ask(std::uint64_t id, const Vector3d& target) {
    msg::RegistrationRequest request;
    request.request_id_(id);
    assign(request.targets_().emplace_back(), target);
    assign(request.targets_().emplace_back(), Vector3d{0, 0, 0.04});
    view_.send("request", request);
  }
  /// The image's origin is where the tip is, moved by `off`.
  void register_at_tip(const Vector3d& off, std::uint64_t id = 7,
                       const Vector3d& target = {0, 0, 0.01}) {
    const Vector3d origin = tip_ + off;
    ask(id, target);
    msg::RegistrationResponse response;
    response.request_id_(id);
    response.valid_(true);
    response.robot_t_image_({1, 0, 0, origin.x(), 0, 1, 0, origin.y(), 0, 0, 1, origin.z()});
    view_.send("registration", response);
  }
  void tell_arm() {
    msg::JointState state;
    write_all_joints(model_, *model_.home(), JointVector::Zero(model_.dof()), Time{99900000000},
                     state);
    view_.send("measured_js", state);
  }

  const TemporaryFolder folder_;
  const config::Node robot_ = config::load(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml");
  const RobotModel model_ = read_robot_model(robot_);
  const Vector3d tip_ = forward_kinematics(model_, *model_.home()).translation();
  ComponentHarness view_{
      built_plugins(),
      {.component = "{plugin: monitor/sections, params: {size_px: 128, view_mm: 100}}",
       .robot = robot_}};
};

TEST_F(SectionsComponentTest, TellWhereTheToolIsInTheImageAndHowFarFromWhatCounts) {
  view_.step(99);
  auto tools = view_.take<msg::ToolInImage>("tool");
  ASSERT_EQ(tools.size(), 1u);
  EXPECT_EQ(tools[0].reason_(), "the image is not registered yet");
  show_volume_and_plan();
  register_at_tip({-0.003, 0, -0.02});  // so the tip is at (3, 0, 20) mm
  tell_arm();
  view_.step(100);
  tools = view_.take<msg::ToolInImage>("tool");
  ASSERT_EQ(tools.size(), 1u);
  ASSERT_TRUE(tools[0].valid_()) << tools[0].reason_();
  EXPECT_LT((to_eigen(tools[0].tip_()) - Vector3d{0.003, 0, 0.02}).norm(), 1e-12);
  EXPECT_NEAR(tools[0].target_distance_(), std::hypot(0.003, 0.01), 1e-12);
  EXPECT_NEAR(tools[0].line_distance_(), 0.003, 1e-12);
  EXPECT_NEAR(tools[0].vessel_distance_(), std::hypot(0.017, 0.01) - 0.003, 1e-12);
  EXPECT_EQ(tools[0].header_().frame_id_(), "image");
}

TEST_F(SectionsComponentTest, StayWithThePlanAndTheVolumeOfTheTaskUntilItAsksOfAnother) {
  const auto tool_at = [&](double time_s) {
    tell_arm();
    static_cast<void>(view_.take<msg::ToolInImage>("tool"));
    view_.step(time_s);
    const auto tools = view_.take<msg::ToolInImage>("tool");
    return tools.empty() ? msg::ToolInImage{} : tools.back();
  };
  const auto axial = [&] {
    const auto images = view_.take<msg::Image>("axial");
    return images.empty() ? std::vector<std::uint8_t>{} : images.back().data_();
  };
  static_cast<void>(axial());
  show_volume_and_plan();
  register_at_tip({-0.003, 0, -0.02});
  const double distance = tool_at(100).target_distance_();
  const auto shown = axial();
  show_volume(0.03);
  show_plan({0, 0, 0.01}, 0.01);  // with another vessel
  const msg::ToolInImage with_own = tool_at(100.1);
  EXPECT_NEAR(with_own.vessel_distance_(), std::hypot(0.017, 0.01) - 0.003, 1e-12);
  EXPECT_EQ(axial(), shown);
  const Vector3d other{0.01, 0, 0.02};
  show_plan(other);
  EXPECT_EQ(tool_at(100.15).target_distance_(), distance);
  EXPECT_EQ(axial(), shown);
  ask(8, other);
  const msg::ToolInImage asked = tool_at(100.2);
  EXPECT_FALSE(asked.valid_()) << "what was registered is not of this plan";
  EXPECT_EQ(asked.reason_(), "the image is not registered yet");
  register_at_tip({-0.003, 0, -0.02}, 8, other);
  EXPECT_NEAR(tool_at(100.25).target_distance_(), 0.007, 1e-12);
  EXPECT_NE(axial(), shown);
}

TEST_F(SectionsComponentTest, TellNoDistancesFromATargetThatIsNoNumber) {
  const Vector3d nowhere{NAN, 0, 0};
  show_plan(nowhere);
  register_at_tip({0, 0, 0}, 7, nowhere);
  tell_arm();
  view_.step(100);
  const auto tools = view_.take<msg::ToolInImage>("tool");
  ASSERT_EQ(tools.size(), 1u);
  EXPECT_FALSE(tools[0].valid_());
  EXPECT_EQ(tools[0].reason_(), "there is no plan of a finite line yet");
}

TEST_F(SectionsComponentTest, ShowThreePicturesWhileSomebodyLooks) {
  static_cast<void>(view_.take<msg::Image>("axial"));
  show_volume_and_plan();
  register_at_tip({-0.003, 0, -0.02});
  tell_arm();
  view_.step(100);
  for (const char* name : {"axial", "coronal", "sagittal"}) {
    const auto images = view_.take<msg::Image>(name);
    ASSERT_EQ(images.size(), 1u) << name;
    EXPECT_EQ(images[0].encoding_(), "bgr8");
    EXPECT_EQ(images[0].width_(), 128u);
    EXPECT_EQ(images[0].data_().size(), 3u * 128 * 128);
    EXPECT_EQ(images[0].header_().frame_id_(), "image");
  }
}

TEST_F(SectionsComponentTest, ShowNoToolThatWasMeasuredLongAgo) {
  const auto axial_at = [&](double time_s) {
    view_.step(time_s);
    const auto images = view_.take<msg::Image>("axial");
    return images.empty() ? msg::Image{} : images.back();
  };
  static_cast<void>(view_.take<msg::Image>("axial"));
  show_volume_and_plan();
  register_at_tip({-0.003, 0, -0.02});
  const auto written = [&] {
    view_.component().write_files(folder_.path());
    return cv::imread(folder_ / "section_axial.png");
  };
  const msg::Image without = axial_at(99.8);
  const cv::Mat written_without = written();
  tell_arm();
  const msg::Image with = axial_at(100);
  EXPECT_GT(cv::norm(written(), written_without, cv::NORM_INF), 0);
  ASSERT_FALSE(without.data_().empty());
  EXPECT_NE(with.data_(), without.data_());
  static_cast<void>(view_.take<msg::ToolInImage>("tool"));
  const msg::Image later = axial_at(101);
  EXPECT_EQ(later.data_(), without.data_());
  EXPECT_EQ(later.header_().stamp_().sec_(), 101);
  const auto tools = view_.take<msg::ToolInImage>("tool");
  ASSERT_EQ(tools.size(), 1u);
  EXPECT_FALSE(tools[0].valid_());
  EXPECT_EQ(tools[0].reason_(), "the arm has not said where it is for the last 0.5 s");
  EXPECT_EQ(cv::norm(written(), written_without, cv::NORM_INF), 0);
}

TEST_F(SectionsComponentTest, WriteTheSectionsThroughTheTargetIntoTheReport) {
  show_volume_and_plan();
  view_.step(100);
  view_.component().write_files(folder_.path());
  for (const char* name : {"axial", "coronal", "sagittal"}) {
    const cv::Mat picture = cv::imread(folder_ / (std::string{"section_"} + name + ".png"));
    EXPECT_EQ(picture.size(), cv::Size(128, 128)) << name;
  }
}

TEST_F(SectionsComponentTest, WithoutAVolumeWriteNothing) {
  view_.step(100);
  view_.component().write_files(folder_.path());
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST(SectionsComponent, RefuseAWindowThatIsTurnedRound) {
  EXPECT_NE(
      refusal_of(built_plugins(),
                 {.component = "{plugin: monitor/sections, params: {window: [100, -100]}}",
                  .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml")})
          .find("'window' is black first"),
      std::string::npos);
}

}  // namespace
}  // namespace armature::monitor::sections
