// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/ik/lines/asking.hpp"

#include <fmt/format.h>

#include <cctype>

#include "armature/config/problems.hpp"
#include "armature/kinds/ik/lines/json_line.hpp"
#include "armature/kinds/ik/lines/reason.hpp"
#include "armature/values/json_text.hpp"

namespace armature {
namespace {

using Code = IkStatus::Code;
using ik_lines::InvalidLine;
using ik_lines::Json;

/// The beginning of a line, fit to be printed.
std::string shown(std::string_view line) {
  constexpr std::size_t kLength = 60;
  std::string text{line.substr(0, kLength)};
  for (char& c : text) {
    if (std::isprint(static_cast<unsigned char>(c)) == 0) c = '?';
  }
  return "'" + text + (line.size() > kLength ? "..." : "") + "'";
}

void expect_id(const Json& answer, const std::optional<std::int64_t>& id) {
  if (!id) return;
  if (!answer.contains("id")) {
    throw InvalidLine(fmt::format("without the 'id' of the question, {}", *id));
  }
  if (answer["id"] != *id) {
    throw InvalidLine(fmt::format("question {}, and {} was asked", json_text(answer["id"]), *id));
  }
}

Code read_code(const Json& answer) {
  if (!answer.contains("status")) throw InvalidLine("without a 'status'");
  std::vector<std::string> known;
  for (const Code code : {Code::ok, Code::out_of_reach, Code::joint_limit, Code::singular,
                          Code::no_convergence, Code::invalid_input}) {
    known.emplace_back(to_string(code));
    if (answer["status"] == known.back()) return code;
  }
  const std::string told = answer["status"].is_string() ? answer["status"].get<std::string>() : "";
  throw InvalidLine(fmt::format("with the status {}{}", json_text(answer["status"]),
                                config::did_you_mean(told, known)));
}

double read_shortfall(const Json& answer, Code code) {
  const char* key = code == Code::out_of_reach     ? "beyond_reach_m"
                    : code == Code::no_convergence ? "residual"
                                                   : "";
  return answer.contains(key) ? ik_lines::number(answer, key) : 0;
}

ToldSolution read_solution(const RobotModel& robot, const Json& solution, const char* redundancy) {
  if (!solution.is_object()) throw InvalidLine("it is not an object");
  if (!solution.contains("joints")) throw InvalidLine("'joints' is missing");
  ToldSolution told{.label = "", .q = ik_lines::joints(robot, solution, "joints"), .redundancy = 0};
  if (solution.contains("label")) {
    if (!solution["label"].is_string()) throw InvalidLine("'label' must be a text");
    told.label = solution["label"].get<std::string>();
  }
  if (solution.contains(redundancy)) told.redundancy = ik_lines::number(solution, redundancy);
  return told;
}

std::vector<ToldSolution> read_solutions(const RobotModel& robot, const IkQuestion& question,
                                         const Json& answer) {
  std::vector<ToldSolution> told;
  if (!answer.contains("solutions")) return told;
  const Json& list = answer["solutions"];
  if (!list.is_array()) throw InvalidLine("with 'solutions' that are no list");
  if (list.size() > IkBranches::kCapacity) {
    throw InvalidLine(
        fmt::format("with {} solutions, at most {} are read", list.size(), IkBranches::kCapacity));
  }
  for (const Json& solution : list) {
    try {
      told.push_back(
          read_solution(robot, solution, ik_lines::redundancy_key(question.redundancy_is_length)));
    } catch (const InvalidLine& error) {
      throw InvalidLine(
          fmt::format("with solution {} of {}: {}", told.size() + 1, list.size(), error.what()));
    }
  }
  return told;
}

/// What ends a search, where it is not as usual.
void add_limits(const IkGoal& goal, Json& line) {
  const IkGoal usual;
  if (goal.tolerance.position_m != usual.tolerance.position_m) {
    line["tolerance_m"] = goal.tolerance.position_m;
  }
  if (goal.tolerance.angle_rad != usual.tolerance.angle_rad) {
    line["tolerance_rad"] = goal.tolerance.angle_rad;
  }
  if (goal.max_iterations != usual.max_iterations) line["max_iterations"] = goal.max_iterations;
}

}  // namespace

std::string question_line(const RobotModel& robot, const IkQuestion& question) {
  Json line = Json::object();
  const IkGoal& goal = question.goal;
  if (question.id) line["id"] = *question.id;
  line["position_m"] = ik_lines::to_json(goal.pose.position);
  if (const auto* direction = std::get_if<Direction>(&goal.pose.orientation)) {
    line["direction"] = ik_lines::to_json(direction->unit);
  } else {
    line["quaternion_xyzw"] =
        ik_lines::to_json(std::get<Eigen::Quaterniond>(goal.pose.orientation).coeffs());
  }
  const bool is_length = question.redundancy_is_length;
  if (goal.redundancy) line[ik_lines::redundancy_key(is_length)] = *goal.redundancy;
  if (const auto last = question.state.last_redundancy) {
    line[ik_lines::last_redundancy_key(is_length)] = *last;
  }
  add_limits(goal, line);
  if (question.seed.size() == robot.dof()) {
    line["seed"] = ik_lines::to_json(robot.to_all(question.seed));
  }
  return json_text(line);
}

Expected<ToldAnswer> read_answer(const RobotModel& robot, const IkQuestion& question,
                                 std::string_view line) {
  try {
    const Json answer = ik_lines::parse_object(line);
    expect_id(answer, question.id);
    ToldAnswer told;
    told.code = read_code(answer);
    told.shortfall = read_shortfall(answer, told.code);
    if (answer.contains("reason") && answer["reason"].is_string()) {
      told.detail =
          ik_lines::detail_in(answer["reason"].get<std::string>(), told.code, told.shortfall);
    }
    const char* remembered = ik_lines::last_redundancy_key(question.redundancy_is_length);
    if (answer.contains(remembered)) {
      told.state.last_redundancy = ik_lines::number(answer, remembered);
    }
    told.solutions = read_solutions(robot, question, answer);
    return told;
  } catch (const InvalidLine& error) {
    return refuse(fmt::format("{}: {}", error.what(), shown(line)));
  }
}

}  // namespace armature
