// SPDX-License-Identifier: Apache-2.0
// Rules proved here:
//  1. every array says everything anew, and names each thing once
//  2. plans on images are drawn in the base, where the registration and the tracker put them
//  3. what is not known, or not finite, is not drawn
#include "plan_picture.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

#include "armature/kinds/chain_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "markers.hpp"

namespace armature::monitor::rviz {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

msg::Point point(double x, double y, double z) {
  msg::Point result;
  assign(result, Vector3d{x, y, z});
  return result;
}

msg::ForbiddenZone zone(const Vector3d& from, const Vector3d& to, double radius) {
  msg::ForbiddenZone result;
  assign(result.from_(), from);
  assign(result.to_(), to);
  result.radius_(radius);
  return result;
}

/// The image is turned by 90 degrees about z and moved by a metre along x.
Eigen::Isometry3d robot_T_image() {
  return Eigen::Translation3d{1, 0, 0} * Eigen::AngleAxisd{M_PI / 2, Vector3d::UnitZ()};
}

msg::RegistrationResponse registration(const std::string& frame) {
  msg::RegistrationResponse answer;
  answer.header_().frame_id_(frame);
  answer.valid_(true);
  Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>{answer.robot_t_image_().data()} =
      robot_T_image().matrix().topRows<3>();
  return answer;
}

ImageInBase registered() {
  ImageInBase image;
  image.hear(registration("base"));
  return image;
}

msg::NeedlePlan needle_plan() {
  msg::NeedlePlan plan;
  plan.markers_() = {point(0.1, 0, 0), point(0, 0.1, 0), point(0, 0, 0.1)};
  plan.entry_(point(0, 0.08, 0));
  plan.target_(point(0, 0.02, 0));
  plan.forbidden_() = {zone({0, 0, 0}, {0.1, 0, 0}, 0.002), zone({0, 0, 0.1}, {0, 0, 0.1}, 0.005)};
  return plan;
}

msg::ImplantPlan implant_plan() {
  msg::ImplantPlan plan;
  plan.markers_() = {point(0.01, 0, 0)};
  plan.sites_().resize(2);
  assign(plan.sites_()[0], Eigen::Isometry3d{Eigen::Translation3d{0, 0.02, 0}});
  assign(plan.sites_()[1],
         Eigen::Translation3d{0, 0.03, 0} * Eigen::AngleAxisd{M_PI / 2, Vector3d::UnitY()});
  return plan;
}

msg::MarkerArray draw(const Plans& plans, const ImageInBase& image = registered()) {
  const msg::MarkerArray array = draw_plans(plans, image, "left/base", Time{} + seconds(3));
  EXPECT_EQ(array.markers_().front().action_(), static_cast<int>(MarkerAction::remove_all));
  std::set<std::pair<std::string, int>> names;
  for (const msg::Marker& marker : array.markers_()) {
    EXPECT_TRUE(names.emplace(marker.ns_(), marker.id_()).second) << marker.ns_();
    EXPECT_EQ(marker.header_().frame_id_(), "left/base");
    EXPECT_TRUE(marker.frame_locked_());
    EXPECT_GT(marker.scale_().x_() * marker.scale_().y_() * marker.scale_().z_(), 0);
  }
  return array;
}

std::map<std::string, std::size_t> drawn(const msg::MarkerArray& array) {
  std::map<std::string, std::size_t> counts;
  for (const msg::Marker& marker : array.markers_()) {
    if (marker.action_() == static_cast<int>(MarkerAction::add)) ++counts[marker.ns_()];
  }
  return counts;
}

const msg::Marker& marker_of(const msg::MarkerArray& array, const std::string& ns, int id = 0) {
  for (const msg::Marker& marker : array.markers_()) {
    if (marker.ns_() == ns && marker.id_() == id) return marker;
  }
  throw std::out_of_range(ns);
}

void expect_at(const msg::Point& at, const Vector3d& expected) {
  EXPECT_NEAR((to_eigen(at) - expected).norm(), 0, 1e-12) << to_eigen(at).transpose();
}

TEST(PlanPicture, OfANeedleIsHeadVesselsLesionEntryAndWay) {
  const msg::NeedlePlan plan = needle_plan();
  const msg::MarkerArray array = draw({.needle = &plan});
  EXPECT_EQ(drawn(array),
            (std::map<std::string, std::size_t>{
                {"head", 1}, {"vessels", 4}, {"lesion", 1}, {"entry", 1}, {"needle", 1}}));
  ASSERT_EQ(marker_of(array, "head").points_().size(), 3U);
  expect_at(marker_of(array, "head").points_()[0], {1, 0.1, 0});
  expect_at(marker_of(array, "lesion").pose_().position_(), {0.98, 0, 0});
  expect_at(marker_of(array, "entry").pose_().position_(), {0.92, 0, 0});
  expect_at(marker_of(array, "needle").pose_().position_(), {0.95, 0, 0});
  EXPECT_NEAR(marker_of(array, "needle").scale_().z_(), 0.06, 1e-12);
}

TEST(PlanPicture, OfAVesselIsACylinderWithRoundEndsAndOfABallABall) {
  const msg::NeedlePlan plan = needle_plan();
  const msg::MarkerArray array = draw({.needle = &plan});
  expect_at(marker_of(array, "vessels", 0).pose_().position_(), {1, 0, 0});
  expect_at(marker_of(array, "vessels", 1).pose_().position_(), {1, 0.05, 0});
  expect_at(marker_of(array, "vessels", 2).pose_().position_(), {1, 0.1, 0});
  EXPECT_EQ(marker_of(array, "vessels", 1).type_(), static_cast<int>(MarkerType::cylinder));
  EXPECT_NEAR(marker_of(array, "vessels", 1).scale_().x_(), 0.004, 1e-12);
  EXPECT_NEAR(marker_of(array, "vessels", 1).scale_().z_(), 0.1, 1e-12);
  expect_at(marker_of(array, "vessels", 3).pose_().position_(), {1, 0, 0.1});
  EXPECT_NEAR(marker_of(array, "vessels", 3).scale_().x_(), 0.01, 1e-12);
}

TEST(PlanPicture, OnAnImageIsNotDrawnBeforeItIsKnownWhereTheImageLies) {
  const msg::NeedlePlan needle = needle_plan();
  const msg::ImplantPlan implant = implant_plan();
  EXPECT_TRUE(drawn(draw({.needle = &needle, .implant = &implant}, {})).empty());
  ImageInBase of_a_tracked_jaw;
  of_a_tracked_jaw.hear(registration("patient"));
  EXPECT_TRUE(drawn(draw({.implant = &implant}, of_a_tracked_jaw)).empty());
}

TEST(PlanPicture, OfImplantsIsTheJawAndAnArrowIntoEverySiteWhereTheTrackerSeesTheJaw) {
  const msg::ImplantPlan plan = implant_plan();
  ImageInBase image;
  image.hear(registration("patient"));
  GuidedChain chain;
  chain.base_T_tracker = Eigen::Translation3d{0, 0, 2};
  chain.tracker_T_patient = Eigen::Translation3d{0, 0.5, 0};
  msg::TFMessage told;
  write_chain(chain, Time{}, told);
  image.hear(told);
  const msg::MarkerArray array = draw({.implant = &plan}, image);
  EXPECT_EQ(drawn(array), (std::map<std::string, std::size_t>{{"jaw", 2}, {"sites", 2}}));
  expect_at(marker_of(array, "jaw", 0).points_()[0], {1, 0.51, 2});
  expect_at(marker_of(array, "jaw", 1).pose_().position_(), {0, 0.5, 2});
  const msg::Marker& site = marker_of(array, "sites", 0);
  expect_at(site.points_()[1], {0.98, 0.5, 2});
  expect_at(site.points_()[0], {0.98, 0.5, 1.97});
  // The drill of the other one lies along x of the image, which is y of the robot.
  expect_at(marker_of(array, "sites", 1).points_()[1], {0.97, 0.5, 2});
  expect_at(marker_of(array, "sites", 1).points_()[0], {0.97, 0.47, 2});
}

TEST(PlanPicture, HasTheIncisionInTheBaseAndTheZonesOfTheWay) {
  msg::PointStamped incision;
  incision.header_().frame_id_("base");
  incision.point_(point(0.3, 0, 0.2));
  msg::MotionGoal goal;
  goal.forbidden_() = {zone({0, 0, 0}, {0, 0, 0.4}, 0.05)};
  Plans plans{.incision = &incision, .way = &goal};
  const msg::MarkerArray array = draw(plans, {});
  EXPECT_EQ(drawn(array), (std::map<std::string, std::size_t>{{"incision", 1}, {"zones", 3}}));
  expect_at(marker_of(array, "incision").pose_().position_(), {0.3, 0, 0.2});
  expect_at(marker_of(array, "zones", 1).pose_().position_(), {0, 0, 0.2});
  plans.way = nullptr;
  EXPECT_EQ(drawn(draw(plans, {})).count("zones"), 0U);
}

TEST(PlanPicture, LeavesOutWhatIsNotFiniteAndAnIncisionInAnotherFrame) {
  msg::NeedlePlan plan = needle_plan();
  plan.entry_(point(kNan, 0, 0));
  plan.markers_()[1] = point(0, kNan, 0);
  plan.forbidden_()[0] = zone({kNan, 0, 0}, {0, 0, 0}, 0.01);
  msg::PointStamped incision;
  incision.header_().frame_id_("camera");
  const msg::MarkerArray array = draw({.needle = &plan, .incision = &incision});
  EXPECT_EQ(drawn(array), (std::map<std::string, std::size_t>{{"head", 1}, {"vessels", 1}}));
  EXPECT_EQ(marker_of(array, "head").points_().size(), 2U);
}

}  // namespace
}  // namespace armature::monitor::rviz
