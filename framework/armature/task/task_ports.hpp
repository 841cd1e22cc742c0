// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/motion/goal_messages.hpp"
#include "armature/runtime/component/ports.hpp"
#include "armature/task/answered_words.hpp"
#include "armature/task/heard_word.hpp"
#include "armature/task/procedure.hpp"

namespace armature ARMATURE_EXPORT {

/// What a task is doing: "searching", 4 of 9; why it does not go on.
struct TaskReport {
  std::string state;
  std::size_t step = 0, steps = 0;
  std::string detail = {};

  /// What the operator reads: "refused: the markers lie nearly on one line".
  std::string line() const { return detail.empty() ? state : state + ": " + detail; }
};

/// Sends a goal, if there is one.
inline void send(const std::optional<MotionGoal>& goal, Time now, Output<msg::MotionGoal>& output) {
  if (!goal) return;
  auto loan = output.loan();
  write_goal(*goal, now, *loan);
  loan.publish();
}

/// The two ports at which an operator meets a task: `operator`, what is said to it, and `state`,
/// what it is doing: every change, and five times a second. Every state has one answer, so that
/// several answers take as many states.
class TaskPorts {
 public:
  TaskPorts(Input<msg::OperatorCommand> operator_words, Output<msg::TaskState> state)
      : operator_{operator_words}, state_{state} {}

  /// Hands new commands to `obey` (OperatorCommand to Expected<void>). A command that is told
  /// again, since its answer has not been seen yet, is obeyed once; one that came too late is
  /// refused. What there is to say of it.
  template <class Obey>
  std::vector<std::string> hear(Time now, const Procedure& procedure, const Obey& obey) {
    std::vector<std::string> lines;
    if (procedure.auto_confirm() && !std::exchange(said_who_confirms_, true)) {
      lines.emplace_back("nobody confirms the steps towards the patient (auto_confirm: true)");
    }
    for (std::size_t i = 0; i < operator_.size(); ++i) {
      const msg::OperatorCommand& message = operator_[i];
      const OperatorCommand command = heard_word(message);
      if (answers_.knows(command, now)) continue;
      Expected<void> obeyed = in_time(command.word, stamp_of(message.header_().stamp_()), now);
      if (obeyed) obeyed = obey(command);
      answers_.add(command, obeyed, now);
      const std::string said =
          command.step.empty() ? command.word : command.word + " " + command.step;
      lines.push_back("the operator says " + said +
                      (obeyed ? "" : ", refused: " + obeyed.error().text));
    }
    return lines;
  }

  /// What the operator reads of it, when that is not what he read before: `line`, unless a step
  /// asks. Other numbers in the report's detail, such as each picture has them, are no news to him.
  std::optional<std::string> publish(Time now, const TaskReport& report, std::string line,
                                     const Procedure& procedure) {
    constexpr Duration kPeriod = seconds(0.2);
    if (procedure.asks()) {
      line = "asks the operator to confirm '" + procedure.steps()[procedure.step()].name + "'";
    }
    if (procedure.paused()) line = "paused: " + line;
    const bool changed = line != line_;
    if (!changed && !answers_.waits() && now - published_ < kPeriod) return std::nullopt;
    const std::string said = std::exchange(words_, words_of(line, report.detail));
    line_ = std::move(line);
    published_ = now;
    auto loan = state_.loan();
    write_header(loan->header_(), now);
    loan->state_() = report.state;
    loan->step_(static_cast<std::uint32_t>(report.step));
    loan->steps_(static_cast<std::uint32_t>(report.steps));
    loan->detail_() = report.detail;
    write_procedure(procedure, *loan);
    const AnsweredWords::Answer& answer = answers_.next();
    loan->answered_(answer.id);
    loan->answer_() = answer.text;
    loan.publish();
    return words_ != said ? std::optional{line_} : std::nullopt;
  }

 private:
  /// The line without the numbers of the detail at its end.
  static std::string words_of(std::string line, const std::string& detail) {
    if (!line.ends_with(detail)) return line;
    const auto begins = line.end() - static_cast<std::ptrdiff_t>(detail.size());
    const auto is_of_number = [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == '-'; };
    line.erase(std::remove_if(begins, line.end(), is_of_number), line.end());
    return line;
  }
  static void write_procedure(const Procedure& procedure, msg::TaskState& state) {
    state.procedure_().resize(procedure.steps().size());
    for (std::size_t i = 0; i < procedure.steps().size(); ++i) {
      state.procedure_()[i].name_() = procedure.steps()[i].name;
      state.procedure_()[i].state_(static_cast<std::uint8_t>(procedure.state_of(i)));
      state.procedure_()[i].asks_(procedure.steps()[i].asks);
    }
    state.auto_confirm_(procedure.auto_confirm());
    state.paused_(procedure.paused());
  }

  Input<msg::OperatorCommand> operator_;
  Output<msg::TaskState> state_;
  std::string line_, words_;  // as told last
  AnsweredWords answers_;
  bool said_who_confirms_ = false;
  Time published_;
};

}  // namespace armature
