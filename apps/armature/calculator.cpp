// SPDX-License-Identifier: Apache-2.0
#include "calculator.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <istream>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <set>
#include <stdexcept>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/robot/kinematics.hpp"
#include "armature/robot/robot_model.hpp"
#include "armature/runtime/plugin_registry.hpp"
#include "exit_code.hpp"
#include "progress.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

/// A line that cannot be answered; the text is the reason that goes into its answer.
struct InvalidLine : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws InvalidLine when an object, however deep, has a key twice: JSON itself would take the
/// last one and say nothing.
Json::parser_callback_t without_duplicates() {
  return [keys = std::vector<std::set<std::string>>{}](int, Json::parse_event_t event,
                                                       Json& parsed) mutable {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key &&
        !keys.back().insert(parsed.get<std::string>()).second) {
      throw InvalidLine(fmt::format("'{}' is given twice", parsed.get<std::string>()));
    }
    return true;
  };
}

Json parse_line(const std::string& line, std::initializer_list<std::string_view> known) {
  Json json = Json::parse(line, without_duplicates(), false);
  if (json.is_discarded()) throw InvalidLine("not JSON");
  if (!json.is_object()) throw InvalidLine("not a JSON object");
  for (const auto& [key, value] : json.items()) {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      throw InvalidLine(fmt::format("unknown key '{}'", key));
    }
  }
  return json;
}

/// Exactly `count` finite numbers.
std::vector<double> numbers(const Json& json, const char* key, std::size_t count) {
  const Json& list = json.at(key);
  if (!list.is_array()) throw InvalidLine(fmt::format("'{}' must be a list of numbers", key));
  if (list.size() != count) {
    throw InvalidLine(fmt::format("'{}' has {} numbers, must have {}", key, list.size(), count));
  }
  std::vector<double> values;
  for (const Json& item : list) {
    if (!item.is_number()) throw InvalidLine(fmt::format("'{}' must be a list of numbers", key));
    values.push_back(item.get<double>());
    if (!std::isfinite(values.back())) throw InvalidLine(fmt::format("'{}' is not finite", key));
  }
  return values;
}

Eigen::Vector3d vector3(const Json& json, const char* key) {
  const auto v = numbers(json, key, 3);
  return {v[0], v[1], v[2]};
}

JointVector joints(const RobotModel& robot, const Json& json, const char* key) {
  const auto values = numbers(json, key, static_cast<std::size_t>(robot.joint_count()));
  const auto independent = robot.contract(values);
  if (!independent) throw InvalidLine(independent.error().text);
  return *independent;
}

Json to_json(const auto& vector) {
  Json list = Json::array();
  for (Eigen::Index i = 0; i < vector.size(); ++i) list.push_back(vector[i]);
  return list;
}

Json answer_fk(const RobotModel& robot, const std::string& line) {
  const Json question = parse_line(line, {"joints"});
  if (!question.contains("joints")) throw InvalidLine("'joints' is missing");
  const Eigen::Isometry3d pose = forward_kinematics(robot, joints(robot, question, "joints"));
  Json answer;
  answer["position_m"] = to_json(Eigen::Vector3d{pose.translation()});
  answer["quaternion_xyzw"] = to_json(Eigen::Quaterniond{pose.rotation()}.coeffs());
  if (robot.pointing_axis()) {
    answer["direction"] = to_json(Eigen::Vector3d{pose.rotation() * *robot.pointing_axis()});
  }
  return answer;
}

/// Neither vanishing nor overflowing when it is made a unit.
bool usable_length(double length) { return length > 1e-9 && std::isfinite(length); }

/// `coefficients` over their length; bit for bit as they are when that is 1 already.
template <class Coefficients>
Coefficients unit(const Coefficients& coefficients, const char* key) {
  const double length = coefficients.norm();
  if (!usable_length(length)) throw InvalidLine(fmt::format("'{}' has no usable length", key));
  constexpr double kRounding = 1e-15;
  return std::abs(length - 1) <= kRounding ? coefficients : Coefficients(coefficients / length);
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
    return Direction{unit(vector3(question, "direction"), "direction")};
  }
  const auto q = numbers(question, "quaternion_xyzw", 4);
  return Eigen::Quaterniond{unit(Eigen::Vector4d{q[0], q[1], q[2], q[3]}, "quaternion_xyzw")};
}

/// `key` is what a redundancy is called, empty where there is none.
Json solution_json(const RobotModel& robot, const IkBranch& branch, std::string_view key) {
  Json json;
  json["label"] = branch.label;
  json["joints"] = to_json(robot.expand(branch.q));
  json["residual_m"] = branch.residual.position_m;
  json["residual_rad"] = branch.residual.angle_rad;
  json["within_limits"] = branch.within_limits;
  json["singular"] = branch.singular;
  if (!key.empty()) json[std::string{key}] = branch.redundancy;
  return json;
}

const char* redundancy_key(const IkSolver& solver) {
  return solver.redundancy_is_length() ? "redundancy_m" : "redundancy_rad";
}

std::optional<double> read_redundancy(const IkSolver& solver, const Json& question) {
  const std::string key = redundancy_key(solver);
  for (const char* other : {"redundancy_rad", "redundancy_m"}) {
    if (question.contains(other) && key != other) {
      throw InvalidLine(fmt::format("'{}' is '{}' for this solver", other, key));
    }
  }
  if (!question.contains(key)) return std::nullopt;
  if (!question[key].is_number()) throw InvalidLine(fmt::format("'{}' must be a number", key));
  return question[key].get<double>();
}

/// What `describe` says behind the name of the status, which the answer carries already.
std::string reason_of(const IkStatus& status) {
  const std::string text = describe(status);
  const std::string name = std::string{to_string(status.code)} + ": ";
  return text.starts_with(name) ? text.substr(name.size()) : text;
}

Json answer_ik(const RobotModel& robot, const IkSolver& solver, const JointVector& home,
               const std::string& line) {
  const Json question =
      parse_line(line, {"position_m", "direction", "quaternion_xyzw", "seed", "redundancy_rad",
                        "redundancy_m", "tolerance_m", "tolerance_rad"});
  if (!question.contains("position_m")) throw InvalidLine("'position_m' is missing");
  IkGoal goal;
  goal.pose.position = vector3(question, "position_m");
  goal.pose.orientation = read_orientation(robot, question);
  goal.redundancy = read_redundancy(solver, question);
  goal.tolerance.position_m = positive(question, "tolerance_m", goal.tolerance.position_m);
  goal.tolerance.angle_rad = positive(question, "tolerance_rad", goal.tolerance.angle_rad);
  const JointVector seed = question.contains("seed") ? joints(robot, question, "seed") : home;
  IkBranches branches;
  IkState state;
  const IkStatus status = solver.solve(goal, seed, branches, state);
  Json answer;
  answer["status"] = to_string(status.code);
  if (status.code != IkStatus::Code::ok) answer["reason"] = reason_of(status);
  answer["solutions"] = Json::array();
  const bool redundant = robot.dof() > 6 || goal.redundancy;
  for (const IkBranch& branch : branches) {
    answer["solutions"].push_back(
        solution_json(robot, branch, redundant ? redundancy_key(solver) : ""));
  }
  return answer;
}

/// One answer per line, whatever the line holds. Empty lines are skipped.
int answer_lines(std::istream& in, std::ostream& out, const auto& answer) {
  std::optional<Progress> progress;
  if (isatty(STDOUT_FILENO) == 0) progress.emplace("lines");  // else the answers show it
  std::uint64_t answered = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    Json json;
    try {
      json = answer(line);
    } catch (const std::exception& error) {
      json["status"] = "invalid_input";
      json["reason"] = error.what();
    }
    out << json.dump() << '\n';
    if (!out) return kFailed;
    if (progress) progress->count(++answered);
  }
  out.flush();
  return kOk;
}

}  // namespace

int run_fk(const ArmChoice& arm, std::istream& in, std::ostream& out) {
  const RobotModel robot = load_arm(arm);
  return answer_lines(in, out, [&](const std::string& line) { return answer_fk(robot, line); });
}

int run_ik(const ArmChoice& arm, const SolverChoice& choice, std::istream& in, std::ostream& out) {
  const RobotModel robot = load_arm(arm);
  PluginRegistry plugins;
  const PluginManifest* plugin = plugins.find(choice.plugin);
  if (!plugin) throw InvalidChoice(plugins.unknown_text(choice.plugin));
  const Params params = params_of(*plugin, choice.params);
  const auto solver = plugins.make<IkSolver>(choice.plugin, robot, params);
  if (!solver) {
    throw InvalidChoice(
        fmt::format("{} refuses robot '{}': {}", choice.plugin, robot.name(), solver.error().text));
  }
  const JointVector home = resting_position(robot);
  return answer_lines(
      in, out, [&](const std::string& line) { return answer_ik(robot, **solver, home, line); });
}

}  // namespace armature
