// SPDX-License-Identifier: Apache-2.0
#include "calculate/calculator.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "armature/kinds/ik/lines/answering.hpp"
#include "armature/robot/kinematics/locked_joints.hpp"
#include "armature/robot/model/robot_model.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"
#include "progress.hpp"
#include "standard_output.hpp"

namespace armature {
namespace {

/// What lines are read from.
class LineInput {
 public:
  explicit LineInput(const std::string& file)
      : in_{file.empty() || file == "-" ? std::cin : file_} {
    if (&in_ == &std::cin) return;
    file_.open(file);
    int error = errno;
    std::error_code none;
    if (std::filesystem::is_directory(file, none)) error = EISDIR;  // which could be opened
    if (file_ && error != EISDIR) return;
    throw InvalidChoice(fmt::format("cannot read '{}': {}", file, std::strerror(error)));
  }
  std::istream& stream() { return in_; }

 private:
  std::ifstream file_;
  std::istream& in_;
};

/// The next line, as std::getline; throws at one that has no end, which would take all memory.
bool next_line(std::istream& in, std::string& line, std::uint64_t number) {
  constexpr std::size_t kLongest = std::size_t{16} << 20U;
  line.clear();
  for (int c = in.get(); c != std::istream::traits_type::eof(); c = in.get()) {
    if (c == '\n') return true;
    if (line.size() == kLongest) {
      throw std::runtime_error(
          fmt::format("line {} of the input is longer than {} bytes", number, kLongest));
    }
    line += static_cast<char>(c);
  }
  return !line.empty();
}

/// One answer per line, whatever the line holds, each out before the next line is waited for. Empty
/// lines are skipped.
int answer_lines(std::istream& in, const auto& answer) {
  std::optional<Progress> progress;
  if (isatty(standard_output_descriptor()) == 0)
    progress.emplace("lines");  // else the answers show it
  std::uint64_t answered = 0, number = 0;
  for (std::string line; next_line(in, line, ++number);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string text = answer(line) + '\n';
    if (std::fputs(text.c_str(), standard_output()) < 0 || std::fflush(standard_output()) != 0) {
      return kFailed;
    }
    ++answered;
    if (progress) progress->count(answered);
  }
  if (in.bad()) throw std::runtime_error("the input cannot be read to its end");
  if (answered == 0) fmt::print(stderr, "armature: the input has no lines to answer\n");
  return kOk;
}

}  // namespace

int run_fk(const ArmChoice& arm, const std::string& input) {
  LineInput lines{input};
  const RobotModel robot = load_arm(arm);
  return answer_lines(lines.stream(),
                      [&](const std::string& line) { return answer_fk(robot, line); });
}

PluginPtr<IkSolver> make_solver(const SolverChoice& choice, const RobotModel& model,
                                PluginRegistry& plugins) {
  tell_warnings(plugins);
  const PluginManifest* plugin = plugins.find(choice.plugin);
  if (!plugin) throw InvalidChoice(plugins.unknown_text(choice.plugin));
  const Params params = params_of(*plugin, choice.params);
  name_crashing_components();
  auto solver = plugins.make<IkSolver>(choice.plugin, model, params);
  if (solver) return std::move(*solver);
  throw InvalidChoice(
      fmt::format("{} refuses robot '{}': {}", choice.plugin, model.name(), solver.error().text));
}

int run_ik(const ArmChoice& arm, const SolverChoice& choice, const std::string& input) {
  LineInput lines{input};
  const RobotModel robot = load_arm(arm), solver_model = without_locked_joints(robot);
  PluginRegistry plugins;
  const PluginPtr<IkSolver> solver = make_solver(choice, solver_model, plugins);
  const JointVector home = resting_position(robot);
  const RunningComponent running{choice.plugin, "solve", "plugin"};
  return answer_lines(lines.stream(), [&](const std::string& line) {
    return answer_ik(robot, *solver, home, line);
  });
}

}  // namespace armature
