// SPDX-License-Identifier: Apache-2.0
#include "calculator.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <istream>
#include <optional>
#include <ostream>

#include "armature/kinds/ik/lines/answering.hpp"
#include "armature/robot/robot_model.hpp"
#include "armature/runtime/plugin_registry.hpp"
#include "exit_code.hpp"
#include "progress.hpp"

namespace armature {
namespace {

/// One answer per line, whatever the line holds, each out before the next line is waited for. Empty
/// lines are skipped.
int answer_lines(std::istream& in, std::ostream& out, const auto& answer) {
  std::optional<Progress> progress;
  if (isatty(STDOUT_FILENO) == 0) progress.emplace("lines");  // else the answers show it
  in.tie(&out);
  std::uint64_t answered = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    out << answer(line) << '\n';
    if (!out) return kFailed;
    if (progress) progress->count(++answered);
  }
  out.flush();
  if (answered == 0) fmt::print(stderr, "armature: the input has no lines to answer\n");
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
