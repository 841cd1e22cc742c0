// SPDX-License-Identifier: Apache-2.0
// Rules proved here:
//  1. every marker is complete: RViz takes it without a warning
//  2. name and id stay; a new path takes the old one's place, and an old one does not linger
//  3. shapes are where the things are
#include "picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "armature/messages/geometry.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/robot/model/test_robots.hpp"

namespace armature::monitor::rviz {
namespace {

using Eigen::Vector3d;

bool in_unit_range(float value) { return value >= 0 && value <= 1; }

std::size_t min_points(int type) {
  switch (static_cast<MarkerType>(type)) {
    case MarkerType::arrow:
    case MarkerType::line_strip: return 2;
    case MarkerType::sphere_list: return 1;
    case MarkerType::triangle_list: return 3;
    default: return 0;
  }
}

/// What RViz checks, or draws wrongly without checking.
void expect_complete(const msg::Marker& marker) {
  SCOPED_TRACE(marker.ns_() + " " + std::to_string(marker.id_()));
  EXPECT_FALSE(marker.ns_().empty());
  EXPECT_FALSE(marker.header_().frame_id_().empty());
  EXPECT_NEAR(to_eigen(marker.pose_().orientation_()).norm(), 1, 1e-12);
  EXPECT_TRUE(to_eigen(marker.pose_().position_()).allFinite());
  if (marker.action_() == static_cast<int>(MarkerAction::remove)) return;
  EXPECT_EQ(marker.action_(), static_cast<int>(MarkerAction::add));
  EXPECT_GT(marker.scale_().x_(), 0);
  if (marker.type_() != static_cast<int>(MarkerType::line_strip)) {
    EXPECT_GT(marker.scale_().y_(), 0);
    EXPECT_GT(marker.scale_().z_(), 0);
  }
  for (const float part : {marker.color_().r_(), marker.color_().g_(), marker.color_().b_()}) {
    EXPECT_TRUE(in_unit_range(part));
  }
  EXPECT_TRUE(in_unit_range(marker.color_().a_()) && marker.color_().a_() > 0) << "invisible";
  EXPECT_GE(marker.points_().size(), min_points(marker.type_()));
  if (marker.type_() == static_cast<int>(MarkerType::triangle_list)) {
    EXPECT_EQ(marker.points_().size() % 3, 0U);
  }
  for (const auto& point : marker.points_()) EXPECT_TRUE(to_eigen(point).allFinite());
  EXPECT_TRUE(marker.colors_().empty());
}

void expect_complete(const msg::MarkerArray& array) {
  std::set<std::pair<std::string, int>> names;
  for (const msg::Marker& marker : array.markers_()) {
    expect_complete(marker);
    EXPECT_TRUE(names.emplace(marker.ns_(), marker.id_()).second)
        << marker.ns_() << " " << marker.id_() << " comes twice";
  }
}

const msg::Marker* find(const msg::MarkerArray& array, const std::string& ns, int id = 0) {
  for (const msg::Marker& marker : array.markers_()) {
    if (marker.ns_() == ns && marker.id_() == id) return &marker;
  }
  return nullptr;
}

bool is_shown(const msg::MarkerArray& array, const std::string& ns, int id = 0) {
  const msg::Marker* marker = find(array, ns, id);
  return marker && marker->action_() == static_cast<int>(MarkerAction::add);
}

bool is_removed(const msg::MarkerArray& array, const std::string& ns, int id = 0) {
  const msg::Marker* marker = find(array, ns, id);
  return marker && marker->action_() == static_cast<int>(MarkerAction::remove);
}

msg::Target target_at(const Vector3d& position, bool valid = true) {
  msg::Target target;
  target.header_().frame_id_("base");
  target.valid_(valid);
  assign(target.position_(), position);
  assign(target.normal_(), Vector3d{-1, 0, 0});
  return target;
}

msg::ToolPath path_of(std::uint64_t goal_id, std::initializer_list<Vector3d> points) {
  msg::ToolPath path;
  path.header_().frame_id_("base");
  path.goal_id_(goal_id);
  for (const Vector3d& point : points) assign(path.position_().emplace_back(), point);
  return path;
}

msg::MotionStatus status_of(std::uint64_t goal_id, std::uint8_t state) {
  msg::MotionStatus status;
  status.goal_id_(goal_id);
  status.state_(state);
  return status;
}

class PictureTest : public ::testing::Test {
 protected:
  msg::MarkerArray draw(const Surroundings& around = {}) const {
    return picture_.draw(q_, stamp_, around);
  }
  RobotModel lamp_ = testing::dental_lamp();
  FrameTree tree_ = FrameTree::make(lamp_, std::nullopt, {}).value();
  Picture picture_{lamp_, tree_, {.axis_length = 0.5, .cone_half_angle = 0.1}};
  JointVector q_ = *lamp_.to_independent(*lamp_.home());
  Time stamp_ = Time{} + seconds(100);
};

TEST_F(PictureTest, DrawsOnlyCompleteMarkersForEveryRobotAnywhere) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random{seed};
  for (const RobotModel& model :
       {lamp_, testing::synthetic_robot(RobotModel::Convention::standard, 7),
        testing::synthetic_robot(RobotModel::Convention::modified, 8)}) {
    const FrameTree tree = FrameTree::make(model, std::nullopt, {.frame_prefix = "left/"}).value();
    const Picture picture{model, tree, {.axis_length = 0.5, .cone_half_angle = 0.1}};
    const msg::Target target = target_at({1, 2, 3});
    msg::FacePose face;
    face.valid_(true);
    set_stamp(face.header_().stamp_(), stamp_);
    const msg::ToolPath path = path_of(1, {{0, 0, 0}, {1, 0, 0}});
    for (int k = 0; k < 50; ++k) {
      const auto array = picture.draw(testing::random_joints(model, random), stamp_,
                                      {&target, &target, &face, &path, true});
      expect_complete(array);
      for (const msg::Marker& marker : array.markers_()) {
        EXPECT_EQ(marker.header_().frame_id_().rfind("left/", 0), 0U);
      }
    }
  }
}

TEST_F(PictureTest, LinksRideOnTheirFramesAndReachFromJointToJoint) {
  const auto array = draw();
  // The boom, 610 mm along a of the first row, ends in the frame j1.
  const msg::Marker* boom = find(array, "links", 1);
  ASSERT_NE(boom, nullptr);
  EXPECT_EQ(boom->type_(), static_cast<int>(MarkerType::cylinder));
  EXPECT_EQ(boom->header_().frame_id_(), "j1");
  EXPECT_TRUE(boom->frame_locked_());
  EXPECT_NEAR(boom->scale_().z_(), 0.610, 1e-12);
  EXPECT_TRUE(to_eigen(boom->pose_().position_()).isApprox(Vector3d{-0.305, 0, 0}, 1e-12));
  const Vector3d axis = to_eigen(boom->pose_().orientation_()) * Vector3d::UnitZ();
  EXPECT_NEAR(std::abs(axis.x()), 1, 1e-12);
}

TEST_F(PictureTest, TheLightPointsAlongTheToolsPointingAxis) {
  const auto array = draw();
  const msg::Marker* light = find(array, "pointing", 0);
  ASSERT_NE(light, nullptr);
  EXPECT_EQ(light->header_().frame_id_(), "tool");
  EXPECT_TRUE(to_eigen(light->points_()[1]).isApprox(Vector3d{0.5, 0, 0}));
  const msg::Marker* cone = find(array, "pointing", 1);
  ASSERT_NE(cone, nullptr);
  for (const auto& point : cone->points_()) {
    const Vector3d p = to_eigen(point);
    EXPECT_TRUE(p.norm() == 0 ||
                std::abs(std::hypot(p.y(), p.z()) / p.x() - std::tan(0.1)) < 1e-12);
  }
}

TEST_F(PictureTest, ShowsATargetWithItsNormalAndTakesAnInvalidOneAway) {
  const msg::Target seen = target_at({1.55, 0, 0.45});
  auto array = draw({.target = &seen});
  EXPECT_TRUE(
      to_eigen(find(array, "target", 0)->pose_().position_()).isApprox(Vector3d{1.55, 0, 0.45}));
  const auto& normal = find(array, "target", 1)->points_();
  EXPECT_TRUE((to_eigen(normal[1]) - to_eigen(normal[0])).isApprox(Vector3d{-0.1, 0, 0}, 1e-9));
  EXPECT_EQ(find(array, "truth"), nullptr) << "nobody told the truth";

  const msg::Target lost = target_at({1.55, 0, 0.45}, false);
  array = draw({.target = &lost});
  EXPECT_TRUE(is_removed(array, "target", 0));
  EXPECT_TRUE(is_removed(array, "target", 1));
}

TEST_F(PictureTest, NeverSendsANumberThatIsNone) {
  const msg::Target broken = target_at({std::nan(""), 0, 0});
  const msg::ToolPath path = path_of(1, {{0, 0, 0}, {std::nan(""), 0, 0}});
  const auto array = draw({.target = &broken, .path = &path, .path_is_followed = true});
  expect_complete(array);
  EXPECT_TRUE(is_removed(array, "target"));
  EXPECT_TRUE(is_removed(array, "path"));
}

TEST_F(PictureTest, TakesAFaceAwayThatIsOlderThanASecond) {
  msg::FacePose face;
  face.header_().frame_id_("left_camera_optical");
  face.valid_(true);
  set_stamp(face.header_().stamp_(), stamp_ - seconds(0.9));
  auto array = draw({.face = &face});
  EXPECT_TRUE(is_shown(array, "face"));
  EXPECT_EQ(find(array, "face")->header_().frame_id_(), "left_camera_optical");
  EXPECT_EQ(stamp_of(find(array, "face")->header_().stamp_()), stamp_ - seconds(0.9));
  set_stamp(face.header_().stamp_(), stamp_ - seconds(1.1));
  EXPECT_TRUE(is_removed(draw({.face = &face}), "face"));
}

TEST_F(PictureTest, ANewPathTakesThePlaceOfTheOldOne) {
  const msg::ToolPath first = path_of(1, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const msg::ToolPath second = path_of(2, {{0, 0, 0}, {0, 1, 0}});
  for (const msg::ToolPath* path : {&first, &second}) {
    const auto array = draw({.path = path, .path_is_followed = true});
    const msg::Marker* line = find(array, "path");
    ASSERT_NE(line, nullptr);
    EXPECT_EQ(line->type_(), static_cast<int>(MarkerType::line_strip));
    EXPECT_EQ(line->points_(), path->position_());
  }
  EXPECT_TRUE(is_removed(draw({.path = &second, .path_is_followed = false}), "path"));
  const msg::ToolPath point = path_of(3, {{0, 0, 0}});
  EXPECT_TRUE(is_removed(draw({.path = &point, .path_is_followed = true}), "path"))
      << "a line needs two points";
}

TEST(GoalWatch, FollowsTheNewestGoalUntilItIsOver) {
  GoalWatch goals;
  EXPECT_TRUE(goals.pursues(1)) << "nothing told yet";
  goals.see(status_of(1, 0));
  goals.see(status_of(1, 1));
  EXPECT_TRUE(goals.pursues(1));
  goals.see(status_of(2, 0));
  goals.see(status_of(1, 3));  // superseded, told late
  EXPECT_FALSE(goals.pursues(1));
  EXPECT_TRUE(goals.pursues(2));
  goals.see(status_of(2, 2));
  EXPECT_FALSE(goals.pursues(2)) << "done";
  EXPECT_TRUE(goals.pursues(3)) << "its path came before its status";
  goals.see(status_of(3, 4));
  EXPECT_FALSE(goals.pursues(3)) << "failed";
}

}  // namespace
}  // namespace armature::monitor::rviz
