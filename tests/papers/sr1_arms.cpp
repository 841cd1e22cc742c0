// SPDX-License-Identifier: Apache-2.0
#include "sr1_arms.hpp"

#include <stdexcept>
#include <string>

#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::paper {

SolvedArm solved_arm(RobotModel model) {
  SolvedArm arm{.model = std::make_shared<const RobotModel>(std::move(model))};
  auto solver = built_plugins().make<IkSolver>("ik/puma_algebraic", *arm.model, Params{});
  if (!solver) throw std::runtime_error(solver.error().text);
  auto held = std::make_shared<PluginPtr<IkSolver>>(std::move(*solver));
  arm.solver = std::shared_ptr<const IkSolver>{held, &**held};
  return arm;
}

namespace {

const RobotModel& file() {
  static const RobotModel model = load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1.yaml");
  return model;
}

SolvedArm with_joints(std::vector<Joint> joints, double d6) {
  return solved_arm(
      RobotParts{.name = "sr1",
                 .convention = file().convention(),
                 .joints = std::move(joints),
                 .frames = {{"tool", 5, Eigen::Isometry3d{Eigen::Translation3d{0, 0, d6}}}}});
}

}  // namespace

SolvedArm sr1_with_tool(double d6) { return with_joints(file().joints(), d6); }

SolvedArm sr1_with_lengths(double d1, double a1, double a3, double d6) {
  auto joints = file().joints();
  joints[0].d = d1;
  joints[1].a = a1;
  joints[3].a = a3;
  return with_joints(joints, d6);
}

SolvedArm sr1_needle() {
  return solved_arm(load_robot_model(ARMATURE_SOURCE_DIR "/configs/robots/sr1_needle.yaml"));
}

Eigen::Isometry3d pose_of(const Figures& rows) {
  Eigen::Isometry3d pose;
  for (std::size_t i = 0; i < 4; ++i) {
    pose.matrix().row(static_cast<Eigen::Index>(i)) = rows[i].numbers();
  }
  return pose;
}

IkGoal goal_of(const Eigen::Isometry3d& base_T_tool) {
  IkGoal goal;
  goal.pose = {base_T_tool.translation(), Eigen::Quaterniond{base_T_tool.linear()}};
  return goal;
}

std::string label_of(const Figures& signs) {
  const Eigen::VectorXd s = signs.numbers();
  const auto digit = [&](Eigen::Index i) { return s[i] > 0 ? "0" : "1"; };
  return std::string{"shoulder"} + digit(0) + "/elbow" + digit(1) + "/wrist" + digit(2);
}

}  // namespace armature::paper
