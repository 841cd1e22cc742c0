// SPDX-License-Identifier: Apache-2.0
#include "test_arms.hpp"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "armature/kinds/declared_params.hpp"
#include "armature/values/angles.hpp"
#include "srs_arm_angle.hpp"

namespace armature {
namespace {

constexpr double kPi = std::numbers::pi;

RobotModel arm_of(RobotModel::Convention convention, std::vector<Joint> joints,
                  const Eigen::Isometry3d& last_T_tool) {
  return {{"arm", convention, std::move(joints), {{"tool", 6, last_T_tool}}, FrameId{}, {}, {}}};
}

/// Rows {theta, d, a, alpha} in degrees and metres.
std::vector<Joint> rows(const std::vector<std::array<double, 4>>& numbers) {
  std::vector<Joint> joints;
  for (const auto& [theta, d, a, alpha] : numbers) {
    Joint joint;
    joint.name = "j" + std::to_string(joints.size() + 1);
    joint.theta = theta * kRadPerDegree, joint.d = d, joint.a = a,
    joint.alpha = alpha * kRadPerDegree;
    joint.lower = -kPi, joint.upper = kPi;
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace

ModelPtr med7() {
  static const ModelPtr model = std::make_shared<const RobotModel>(
      load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/med7.yaml"));
  return model;
}

ModelPtr med7_flange() {
  return std::make_shared<const RobotModel>(
      arm_of(med7()->convention(), med7()->joints(), Eigen::Isometry3d::Identity()));
}

ModelPtr uneven_arm() {
  auto joints = rows({{20, 0.1, 0.05, 30},
                      {-90, 0, 0, 90},
                      {0, -0.5, 0, 90},
                      {45, 0, 0, 90},
                      {10, 0.3, 0, -90},
                      {0, 0, 0, -90},
                      {70, -0.1, 0, 90}});
  constexpr std::array<std::array<double, 2>, 7> kLimits{
      {{-150, 80}, {-60, 170}, {-200, 100}, {-150, 95}, {-90, 140}, {-130, 70}, {-300, 300}}};
  for (std::size_t i = 0; i < 7; ++i) {
    joints[i].lower = kLimits[i][0] * kRadPerDegree;
    joints[i].upper = kLimits[i][1] * kRadPerDegree;
  }
  const Eigen::Isometry3d tool = Eigen::Translation3d{0.05, -0.02, 0.1} *
                                 Eigen::AngleAxisd{0.7, Eigen::Vector3d{1, 2, 3}.normalized()};
  return std::make_shared<const RobotModel>(arm_of(RobotModel::Convention::modified, joints, tool));
}

ModelPtr narrow_arm() {
  auto joints = med7()->joints();
  constexpr std::array<std::array<double, 2>, 7> kLimits{
      {{-60, 40}, {-30, 70}, {-20, 90}, {-100, 110}, {-45, 45}, {-80, 20}, {-10, 120}}};
  for (std::size_t i = 0; i < 7; ++i) {
    joints[i].lower = kLimits[i][0] * kRadPerDegree;
    joints[i].upper = kLimits[i][1] * kRadPerDegree;
  }
  return with_joints(*med7_flange(), joints);
}

ModelPtr with_joints(const RobotModel& model, std::vector<Joint> joints) {
  return std::make_shared<const RobotModel>(
      arm_of(model.convention(), std::move(joints), model.frame(model.tool()).parent_T_frame));
}

ModelPtr without_limits(const RobotModel& model) {
  auto joints = model.joints();
  for (Joint& joint : joints) joint.lower = -kPi, joint.upper = kPi;
  return with_joints(model, joints);
}

RobotModel random_arm(std::mt19937_64& random) {
  std::uniform_real_distribution<double> any{-1, 1};
  const auto sign = [&] { return any(random) < 0 ? -1.0 : 1.0; };
  const bool modified = any(random) < 0;
  // Of link i - 1 and joint i; a standard row 7 gets link 0's.
  std::array<double, 7> twist, d{any(random),
                                 0,
                                 sign() * (0.2 + std::abs(any(random))),
                                 0,
                                 sign() * (0.2 + std::abs(any(random))),
                                 0,
                                 any(random)};
  for (double& alpha : twist) alpha = 90 * sign();
  std::vector<std::array<double, 4>> numbers;
  for (std::size_t i = 0; i < 7; ++i) {
    const std::size_t link = modified ? i : (i + 1) % 7;
    const bool end = link == 0;  // before joint 1, or after joint 7: anything
    numbers.push_back(
        {180 * any(random), d[i], end ? any(random) : 0, end ? 180 * any(random) : twist[link]});
  }
  Eigen::Isometry3d tool = Eigen::Isometry3d::Identity();
  tool.translate(Eigen::Vector3d{any(random), any(random), any(random)});
  tool.rotate(
      Eigen::AngleAxisd{3 * any(random), Eigen::Vector3d{1, 0.5, any(random)}.normalized()});
  return arm_of(modified ? RobotModel::Convention::modified : RobotModel::Convention::standard,
                rows(numbers), tool);
}

std::shared_ptr<const IkSolver> solver_for(const RobotModel& model, const std::string& objective) {
  const Params params = declared_params(ARMATURE_SOURCE_DIR "/plugins/ik/srs_arm_angle/plugin.yaml",
                                        objective.empty() ? "" : "{objective: " + objective + "}");
  return std::move(SrsArmAngle::make(model, params).value());
}

JointVector joints_at_limits(const RobotModel& model, std::mt19937_64& random) {
  JointVector q = random_joints(model, random);
  for (int i = 0; i < 7; ++i) {
    if (random() % 2 == 0) continue;
    q[i] = random() % 2 == 0 ? model.lower()[i] : model.upper()[i];
  }
  return q;
}

JointVector joints_of(const SrsArm& arm, const Angles& t) {
  JointVector q(7);
  for (std::size_t i = 0; i < 7; ++i) q.data()[i] = arm.joint(i, t[i]);
  return q;
}

Angles angles_of(const SrsArm& arm, const JointVector& q) {
  Angles t;
  for (std::size_t i = 0; i < 7; ++i) t[i] = arm.canonical(i, q.data()[i]);
  return t;
}

}  // namespace armature
