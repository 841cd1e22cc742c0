// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/lines/answering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <initializer_list>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/kinds/ik/farthest.hpp"
#include "armature/kinds/ik/lines/json_line.hpp"
#include "armature/kinds/ik/lines/reason.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/values/json_text.hpp"

namespace armature {
namespace {

using ik_lines::InvalidLine;
using ik_lines::Json;
using ik_lines::number;
using ik_lines::numbers;
using ik_lines::to_json;

void expect_known(const Json& json, std::initializer_list<std::string_view> known) {
  for (const auto& [key, value] : json.items()) {
    if (key == "id" && (value.is_number() || value.is_string())) continue;
    if (key == "id") throw InvalidLine("'id' must be a number or a text");
    if (std::ranges::find(known, key) == known.end()) {
      const std::vector<std::string> names{known.begin(), known.end()};
      throw InvalidLine(fmt::format("unknown key '{}'{}", key, config::did_you_mean(key, names)));
    }
  }
}

/// The answer that `answer` makes of the question, under the question's id.
std::string answered(std::string_view line, std::initializer_list<std::string_view> known,
                     const auto& answer) {
  Json whole = Json::object();
  try {
    const Json question = ik_lines::parse_object(line);
    if (question.contains("id")) whole["id"] = question["id"];
    expect_known(question, known);
    whole.update(answer(question));
  } catch (const std::exception& error) {
    whole["status"] = "invalid_input";
    whole["reason"] = error.what();
  }
  return json_text(whole);
}

Eigen::Vector3d vector3(const Json& json, const char* key) {
  const auto v = numbers(json, key, 3);
  return {v[0], v[1], v[2]};
}

/// A positive number of the line, or `usual`.
double positive(const Json& json, const char* key, double usual) {
  if (!json.contains(key)) return usual;
  const double value = json[key].is_number() ? json[key].get<double>() : 0;
  if (!(value > 0)) throw InvalidLine(fmt::format("'{}' must be a positive number", key));
  return value;
}

Orientation read_orientation(const RobotModel& robot, const Json& question) {
  if (question.contains("direction") == question.contains("quaternion_xyzw")) {
    throw InvalidLine("give either 'direction' or 'quaternion_xyzw'");
  }
  if (question.contains("direction")) {
    if (!robot.pointing_axis()) {
      throw InvalidLine("the robot file names no 'pointing_axis'; give 'quaternion_xyzw'");
    }
    return Direction{vector3(question, "direction")};
  }
  const auto q = numbers(question, "quaternion_xyzw", 4);
  return Eigen::Quaterniond{q[3], q[0], q[1], q[2]};
}

/// The number that `key_of` names in the solver's unit; it is refused in the other one.
std::optional<double> read_redundancy(const IkSolver& solver, const Json& question,
                                      const char* (*key_of)(bool is_length)) {
  const bool is_length = solver.redundancy_is_length();
  const char *key = key_of(is_length), *other = key_of(!is_length);
  if (question.contains(other)) {
    throw InvalidLine(fmt::format("'{}' is '{}' for this solver", other, key));
  }
  if (!question.contains(key)) return std::nullopt;
  const double value = number(question, key);
  if (std::abs(value) > kFarthest) throw InvalidLine(fmt::format("'{}' is more than 1e100", key));
  return value;
}

int read_iterations(const Json& question, int usual) {
  if (!question.contains("max_iterations")) return usual;
  const Json& value = question["max_iterations"];
  const bool whole =
      value.is_number_integer() && value >= 1 && value <= std::numeric_limits<int>::max();
  if (!whole) {
    throw InvalidLine("'max_iterations' must be a whole number from 1 to 2147483647");
  }
  return value.get<int>();
}

IkGoal read_goal(const RobotModel& robot, const IkSolver& solver, const Json& question) {
  if (!question.contains("position_m")) throw InvalidLine("'position_m' is missing");
  const ToolPose written{vector3(question, "position_m"), read_orientation(robot, question)};
  const auto pose = checked(written, "the goal's");
  if (!pose) throw InvalidLine(pose.error().text);
  IkGoal goal;
  goal.pose = *pose;
  goal.redundancy = read_redundancy(solver, question, ik_lines::redundancy_key);
  goal.tolerance.position_m = positive(question, "tolerance_m", goal.tolerance.position_m);
  goal.tolerance.angle_rad = positive(question, "tolerance_rad", goal.tolerance.angle_rad);
  goal.max_iterations = read_iterations(question, goal.max_iterations);
  return goal;
}

Json status_json(const IkStatus& status) {
  Json json{{"status", to_string(status.code)}};
  if (status.code == IkStatus::Code::ok) return json;
  json["reason"] = ik_lines::reason_of(status);
  if (status.shortfall == 0) return json;
  if (status.code == IkStatus::Code::out_of_reach) json["beyond_reach_m"] = status.shortfall;
  if (status.code == IkStatus::Code::no_convergence) json["residual"] = status.shortfall;
  return json;
}

/// The branch with its joints turned by whole turns into the limits, as near to `seed` as they
/// allow, where it keeps the limits at all.
IkBranch turned(const RobotModel& robot, const IkGoal& goal, const JointVector& seed,
                IkBranch branch) {
  JointVector q = branch.q;
  if (!branch.within_limits || !unwind(robot, seed, q) || q == branch.q) return branch;
  const Eigen::Vector3d axis = robot.pointing_axis().value_or(Eigen::Vector3d::UnitX());
  branch.q = q;
  branch.residual = residual(forward_kinematics(robot, q), axis, goal.pose);
  return branch;
}

/// `key` is what a redundancy is called, empty where there is none.
Json solution_json(const RobotModel& robot, const IkBranch& branch, std::string_view key) {
  Json json;
  json["label"] = branch.label;
  json["joints"] = to_json(robot.to_all(branch.q));
  json["residual_m"] = branch.residual.position_m;
  json["residual_rad"] = branch.residual.angle_rad;
  json["within_limits"] = branch.within_limits;
  json["singular"] = branch.singular;
  if (!key.empty()) json[std::string{key}] = branch.redundancy;
  return json;
}

/// Under every solution the redundancies at which its branch keeps the limits, when the solver
/// tells them.
void add_intervals(const IkSolver& solver, const IkGoal& goal, const JointVector& seed,
                   Json& solutions) {
  RedundancyIntervals intervals;
  if (!solver.feasible_redundancy(goal, seed, intervals)) return;
  const std::string key =
      solver.redundancy_is_length() ? "redundancy_intervals_m" : "redundancy_intervals_rad";
  for (Json& solution : solutions) {
    Json& list = solution[key] = Json::array();
    for (const RedundancyInterval& interval : intervals) {
      if (solution["label"] == interval.label) list.push_back({interval.lower, interval.upper});
    }
  }
}

Json fk_json(const RobotModel& robot, const Json& question) {
  if (!question.contains("joints")) throw InvalidLine("'joints' is missing");
  const Eigen::Isometry3d pose =
      forward_kinematics(robot, ik_lines::joints(robot, question, "joints"));
  Json answer;
  answer["position_m"] = to_json(Eigen::Vector3d{pose.translation()});
  answer["quaternion_xyzw"] = to_json(Eigen::Quaterniond{pose.rotation()}.coeffs());
  if (robot.pointing_axis()) {
    answer["direction"] = to_json(Eigen::Vector3d{pose.rotation() * *robot.pointing_axis()});
  }
  return answer;
}

Json ik_json(const RobotModel& robot, const IkSolver& solver, const JointVector& home,
             const Json& question) {
  const IkGoal goal = read_goal(robot, solver, question);
  const JointVector seed =
      question.contains("seed") ? ik_lines::joints(robot, question, "seed") : home;
  IkBranches branches;
  IkState state{read_redundancy(solver, question, ik_lines::last_redundancy_key)};
  Json answer = status_json(solver.solve(goal, seed, branches, state));
  const bool is_length = solver.redundancy_is_length();
  if (state.last_redundancy) {
    answer[ik_lines::last_redundancy_key(is_length)] = *state.last_redundancy;
  }
  answer["solutions"] = Json::array();
  const int taken = std::holds_alternative<Direction>(goal.pose.orientation) ? 5 : 6;
  const bool redundant = robot.dof() > taken;
  for (const IkBranch& branch : branches) {
    const bool has_one = goal.redundancy || (redundant && solver.redundancy_of(branch.q));
    answer["solutions"].push_back(
        solution_json(robot, turned(robot, goal, seed, branch),
                      has_one ? ik_lines::redundancy_key(is_length) : ""));
  }
  add_intervals(solver, goal, seed, answer["solutions"]);
  return answer;
}

}  // namespace

std::string answer_fk(const RobotModel& robot, std::string_view line) {
  return answered(line, {"joints"}, [&](const Json& question) { return fk_json(robot, question); });
}

std::string answer_ik(const RobotModel& robot, const IkSolver& solver, const JointVector& home,
                      std::string_view line) {
  return answered(line,
                  {"position_m", "direction", "quaternion_xyzw", "seed", "redundancy_rad",
                   "redundancy_m", "last_redundancy_rad", "last_redundancy_m", "tolerance_m",
                   "tolerance_rad", "max_iterations"},
                  [&](const Json& question) { return ik_json(robot, solver, home, question); });
}

}  // namespace armature
