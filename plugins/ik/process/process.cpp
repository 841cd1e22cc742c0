// SPDX-License-Identifier: Apache-2.0
#include "process.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "armature/robot/kinematics/task_error.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "interned_text.hpp"

namespace armature::ik::process {
namespace {

using Code = IkStatus::Code;

bool misses(const PoseResidual& residual, const IkGoal& goal) {
  constexpr double kRounding = 1e-12;  // [m], [rad]
  return !(residual.position_m <= goal.tolerance.position_m + kRounding &&
           residual.angle_rad <= goal.tolerance.angle_rad + kRounding);
}

}  // namespace

Expected<std::unique_ptr<IkSolver>> Process::make(const RobotModel& model, const Params& params) {
  const auto parameters = Parameters::read(params);
  auto command = find_command(parameters.command, parameters.folder);
  if (!command) return tl::unexpected{command.error()};
  std::unique_ptr<Process> made{new Process{model, std::move(*command), parameters}};
  const JointVector resting = resting_position(model);
  const auto told = made->ask_once({.goal = {.pose = task_pose(model, resting)}, .seed = resting});
  if (!told) return tl::unexpected{told.error()};
  if (told->code == Code::invalid_input) {
    return refuse(
        fmt::format("the program '{}' does not accept the robot's resting position as a goal: {}",
                    made->command_.text(), told->detail));
  }
  return made;
}

IkStatus Process::solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                        IkState& state) const {
  out.clear();
  if (const char* why = invalid_input(*model_, goal, seed)) return {Code::invalid_input, 0, why};
  if (state.last_redundancy && !std::isfinite(*state.last_redundancy)) {
    return {Code::invalid_input, 0, "the last redundancy is not finite"};
  }
  const std::lock_guard one_at_a_time{mutex_};
  const auto told = ask({.goal = goal, .seed = seed, .state = state});
  if (!told) return {Code::no_convergence, 0, kept(told.error().text)};
  const IkStatus status = believed(goal, *told, out);
  if (out.count > 0 && told->state.last_redundancy) state = told->state;
  return status;
}

/// Asks, and keeps the book of what went wrong.
Expected<ToldAnswer> Process::ask(IkQuestion question) const {
  if (failures_ > parameters_.max_restarts) return refuse(last_failure_);
  auto told = ask_once(std::move(question));
  if (told) {
    failures_ = 0;
    return told;
  }
  program_.reset();
  ++failures_;
  last_failure_ = told.error().text + "; " + what_comes_next();
  return refuse(last_failure_);
}

std::string Process::what_comes_next() const {
  const auto restarts = parameters_.max_restarts;
  if (failures_ <= restarts) {
    return fmt::format("it is started again for the next goal, {} of {} times in a row", failures_,
                       restarts);
  }
  if (restarts == 0) return "it is not started again, since max_restarts is 0";
  return fmt::format("{} restarts in a row did not help, and it is left alone", restarts);
}

Expected<ToldAnswer> Process::ask_once(IkQuestion question) const {
  const auto failed = [&](const std::string& what) {
    if (program_) program_->kill();
    return refuse(fmt::format("the program '{}' {}", command_.text(), what));
  };
  if (!program_) {
    auto started = Program::start(command_);
    if (!started) return failed(started.error().text);
    program_ = std::move(*started);
    has_answered_ = false;
  }
  question.redundancy_is_length = redundancy_is_length();
  question.id = ++questions_;
  const double timeout_s = has_answered_ ? parameters_.timeout : parameters_.start_timeout;
  const auto line = program_->ask(question_line(*model_, question), timeout_s);
  if (!line) return failed(line.error().text);
  auto told = read_answer(*model_, question, *line);
  if (!told) return failed("answers " + told.error().text);
  has_answered_ = true;
  return told;
}

/// What was told and stands up to forward kinematics; the program's word for nothing else.
IkStatus Process::believed(const IkGoal& goal, const ToldAnswer& told, IkBranches& out) const {
  bool inside = false;
  for (std::size_t i = 0; i < told.solutions.size(); ++i) {
    const ToldSolution& solution = told.solutions[i];
    const auto label = lasting_label(solution.label);
    IkBranch branch =
        branch_at(*model_, goal, solution.q, label && !label->empty() ? *label : "solution");
    branch.redundancy = solution.redundancy;
    std::string wrong;
    if (!label) wrong = "has a label that is too long, or the 257th: a label names a branch";
    if (misses(branch.residual, goal)) {
      wrong = fmt::format("misses the goal by {:.3g} m and {:.3g} rad", branch.residual.position_m,
                          branch.residual.angle_rad);
    }
    if (!wrong.empty()) {
      out.clear();
      return refused(fmt::format("answers with solution {} of {}, which {}", i + 1,
                                 told.solutions.size(), wrong));
    }
    inside = inside || branch.within_limits;
    out.add() = branch;
  }
  if (inside) return {};
  if (out.count > 0) {
    const bool told_so = told.code == Code::joint_limit && !told.detail.empty();
    return {Code::joint_limit, 0,
            told_so ? kept(told.detail) : "every solution of the program leaves the joint limits"};
  }
  if (told.code == Code::ok) return refused("says 'ok' and tells no solution");
  return {told.code, told.shortfall, kept(told.detail)};
}

IkStatus Process::refused(const std::string& what) const {
  return {Code::no_convergence, 0, kept(fmt::format("the program '{}' {}", command_.text(), what))};
}

std::string_view Process::kept(const std::string& detail) const {
  if (const auto lasting = lasting_detail(detail)) return *lasting;
  errors_.put(detail);
  return "a reason behind 1024 different ones: it is printed on standard error";
}

}  // namespace armature::ik::process

ARMATURE_PLUGIN(armature::ik::process::Process);
