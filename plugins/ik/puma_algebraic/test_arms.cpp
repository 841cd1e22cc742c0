// SPDX-License-Identifier: Apache-2.0
#include "test_arms.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "armature/robot/kinematics.hpp"
#include "puma_algebraic.hpp"

namespace armature {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

ModelPtr robot(const std::string& name) {
  return std::make_shared<const RobotModel>(
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/" + name + ".yaml"));
}

ModelPtr with_axis(const RobotModel& model, std::optional<Eigen::Vector3d> axis) {
  return std::make_shared<const RobotModel>(model.name(), model.convention(), model.joints(),
                                            model.frames(), model.tool(), std::move(axis),
                                            model.home());
}

/// Rows {theta, d, a, alpha} in degrees and metres.
std::vector<Joint> revolute_rows(const std::vector<std::array<double, 4>>& rows, double limit) {
  std::vector<Joint> joints;
  for (const auto& [theta, d, a, alpha] : rows) {
    Joint joint;
    joint.name = "j" + std::to_string(joints.size() + 1);
    joint.theta = theta * kDegree, joint.d = d, joint.a = a, joint.alpha = alpha * kDegree;
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
ModelPtr sr1_needle_for_rotations() { return with_axis(*sr1_needle(), std::nullopt); }

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
    joints[i].lower = kLimits[i][0] * kDegree;
    joints[i].upper = kLimits[i][1] * kDegree;
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
  return std::make_shared<const RobotModel>("arm", convention, std::move(joints),
                                            std::vector<NamedFrame>{{"tool", last, last_T_tool}},
                                            FrameId{}, std::move(axis), std::nullopt);
}

std::shared_ptr<const IkSolver> solver_for(const RobotModel& model) {
  return std::move(PumaAlgebraic::make(model, Params{}).value());
}

IkGoal rotation_goal(const RobotModel& model, const JointVector& q) {
  const Eigen::Isometry3d pose = forward_kinematics(model, q);
  IkGoal goal;
  goal.pose = {pose.translation(), Eigen::Quaterniond{pose.linear()}};
  return goal;
}

IkGoal direction_goal(const RobotModel& model, const JointVector& q) {
  const Eigen::Isometry3d pose = forward_kinematics(model, q);
  IkGoal goal;
  goal.pose = {pose.translation(), Direction{pose.linear() * *model.pointing_axis()}};
  return goal;
}

JointVector random_joints(const RobotModel& model, std::mt19937_64& random) {
  JointVector q(model.dof());
  for (int i = 0; i < model.dof(); ++i) {
    q[i] = std::uniform_real_distribution{model.lower()[i], model.upper()[i]}(random);
  }
  return q;
}

double joint_distance(const RobotModel& model, const JointVector& a, const JointVector& b) {
  double largest = 0;
  for (int i = 0; i < model.dof(); ++i) {
    const double d = turns_freely(model, i) ? wrap_angle(a[i] - b[i]) : a[i] - b[i];
    largest = std::max(largest, std::abs(d));
  }
  return largest;
}

void PumaTest::use(const ModelPtr& model) {
  model_ = model;
  arm_ = puma_arm(*model).value();
  solver_ = solver_for(*model);
}

IkStatus PumaTest::solve(const IkGoal& goal, const JointVector& seed) {
  goal_ = goal;
  IkState state;
  return solver_->solve(goal, seed, found_, state);
}

void PumaTest::expect_right(double tolerance) const {
  for (const IkBranch& branch : found_) {
    const PoseResidual actual =
        residual(forward_kinematics(model(), branch.q),
                 model().pointing_axis().value_or(Eigen::Vector3d::UnitZ()), goal_.pose);
    EXPECT_LE(actual.position_m, tolerance) << branch.label;
    EXPECT_LE(actual.angle_rad, tolerance) << branch.label;
    EXPECT_NEAR(branch.residual.position_m, actual.position_m, 1e-13) << branch.label;
    EXPECT_NEAR(branch.residual.angle_rad, actual.angle_rad, 1e-13) << branch.label;
  }
}

double PumaTest::nearest_to(const JointVector& q) const {
  double nearest = 10;
  for (const IkBranch& branch : found_) {
    nearest = std::min(nearest, joint_distance(model(), branch.q, q));
  }
  return nearest;
}

}  // namespace armature
