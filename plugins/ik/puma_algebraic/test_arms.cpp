// SPDX-License-Identifier: Apache-2.0
#include "test_arms.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "armature/kinds/ik/test_goals.hpp"
#include "armature/values/angles.hpp"
#include "puma_algebraic.hpp"

namespace armature {
namespace {

ModelPtr robot(const std::string& name) {
  return std::make_shared<const RobotModel>(
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/" + name + ".yaml"));
}

ModelPtr with_axis(const RobotModel& model, std::optional<Eigen::Vector3d> axis) {
  RobotParts parts = model.parts();
  parts.pointing_axis = std::move(axis);
  return std::make_shared<const RobotModel>(std::move(parts));
}

/// Rows {theta, d, a, alpha} in degrees and metres.
std::vector<Joint> revolute_rows(const std::vector<std::array<double, 4>>& rows, double limit) {
  std::vector<Joint> joints;
  for (const auto& [theta, d, a, alpha] : rows) {
    Joint joint;
    joint.name = "j" + std::to_string(joints.size() + 1);
    joint.theta = theta * kRadPerDegree, joint.d = d, joint.a = a,
    joint.alpha = alpha * kRadPerDegree;
    joint.lower = -limit, joint.upper = limit;
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace

ModelPtr sr1() {
  static const ModelPtr model = robot("sr1");
  return model;
}
ModelPtr sr1_needle() {
  static const ModelPtr model = robot("sr1_needle");
  return model;
}
ModelPtr sr1_pointing() { return with_axis(*sr1(), Eigen::Vector3d::UnitZ()); }

ModelPtr standard_puma560() {
  auto joints = revolute_rows({{0, 0, 0, 90},
                               {0, 0, 0.4318, 0},
                               {0, 0.15005, 0.0203, -90},
                               {0, 0.4318, 0, 90},
                               {0, 0, 0, -90},
                               {0, 0, 0, 0}},
                              0);
  constexpr std::array<std::array<double, 2>, 6> kLimits{
      {{-160, 160}, {-45, 225}, {-225, 45}, {-110, 170}, {-100, 100}, {-266, 266}}};
  for (std::size_t i = 0; i < 6; ++i) {
    joints[i].lower = kLimits[i][0] * kRadPerDegree;
    joints[i].upper = kLimits[i][1] * kRadPerDegree;
  }
  return arm_of(RobotModel::Convention::standard, joints);
}

ModelPtr industrial_arm() {
  const auto joints = revolute_rows({{0, 0.675, 0, 180},
                                     {0, 0, 0.35, 90},
                                     {-90, 0, 1.15, 0},
                                     {0, -1, 0.041, 90},
                                     {0, 0, 0, -90},
                                     {180, -0.215, 0, 90}},
                                    2.9);
  const Eigen::Isometry3d tool = Eigen::Translation3d{0.05, -0.02, 0.1} *
                                 Eigen::AngleAxisd{0.7, Eigen::Vector3d{1, 2, 3}.normalized()};
  return arm_of(RobotModel::Convention::modified, joints, tool);
}

ModelPtr without_limits(const RobotModel& model) {
  auto joints = model.joints();
  for (Joint& joint : joints) joint.lower = -std::numbers::pi, joint.upper = std::numbers::pi;
  return arm_of(model.convention(), joints, model.frame(model.tool()).parent_T_frame,
                model.pointing_axis());
}

ModelPtr random_arm(std::mt19937_64& random) {
  std::uniform_real_distribution<double> any{-1, 1};
  const auto sign = [&] { return any(random) < 0 ? -1.0 : 1.0; };
  const auto length = [&] { return any(random) < -0.4 ? 0 : any(random); };
  const bool modified = any(random) < 0;
  std::vector<std::array<double, 4>> rows;  // of link i - 1 and joint i
  const std::array<double, 6> twist{180 * any(random), 90 * sign(), any(random) < 0 ? 0.0 : 180.0,
                                    90 * sign(),       90 * sign(), 90 * sign()};
  const std::array<double, 6> a{length(), length(), sign() * (0.3 + 0.5 * std::abs(any(random))),
                                length(), 0,        0};
  const std::array<double, 6> d{length(), length(), length(), sign() * (0.3 + std::abs(length())),
                                0,        length()};
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t link = modified ? i : (i + 1) % 6;  // a standard row 6 gets link 0's
    rows.push_back({180 * any(random), d[i], a[link], twist[link]});
  }
  Eigen::Isometry3d tool = Eigen::Isometry3d::Identity();
  tool.translate(Eigen::Vector3d{length(), length(), length()});
  tool.rotate(
      Eigen::AngleAxisd{3 * any(random), Eigen::Vector3d{1, 0.5, any(random)}.normalized()});
  return arm_of(modified ? RobotModel::Convention::modified : RobotModel::Convention::standard,
                revolute_rows(rows, std::numbers::pi), tool);
}

ModelPtr arm_of(RobotModel::Convention convention, std::vector<Joint> joints,
                const Eigen::Isometry3d& last_T_tool, std::optional<Eigen::Vector3d> axis) {
  const int last = static_cast<int>(joints.size()) - 1;
  return std::make_shared<const RobotModel>(RobotParts{.name = "arm",
                                                       .convention = convention,
                                                       .joints = std::move(joints),
                                                       .frames = {{"tool", last, last_T_tool}},
                                                       .pointing_axis = std::move(axis)});
}

std::shared_ptr<const IkSolver> solver_for(const RobotModel& model) {
  return std::move(PumaAlgebraic::make(model, Params{}).value());
}

void PumaTest::use(const ModelPtr& model) {
  static const IkLawTools kTools;
  subject_ = {.model = model, .solver = solver_for(*model), .seed = random_()};
  arm_ = puma_arm(*model).value();
  probe_.emplace(subject_, kTools);
}

IkGoal PumaTest::rotation_goal(const JointVector& q) const { return test::goal_at(model(), q); }

const IkStatus& PumaTest::solve(const IkGoal& goal, const JointVector& seed) {
  const IkStatus& status = probe_->solve(goal, seed);
  found_ = probe_->found();
  return status;
}

void PumaTest::expect_right(double tolerance) const {
  for (const IkBranch& branch : found_) {
    const PoseResidual actual = probe_->residual_of(branch.q, probe_->goal());
    EXPECT_LE(actual.position_m, tolerance) << branch.label;
    EXPECT_LE(actual.angle_rad, tolerance) << branch.label;
    EXPECT_NEAR(branch.residual.position_m, actual.position_m, 1e-13) << branch.label;
    EXPECT_NEAR(branch.residual.angle_rad, actual.angle_rad, 1e-13) << branch.label;
  }
}

}  // namespace armature
