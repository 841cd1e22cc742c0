// SPDX-License-Identifier: Apache-2.0
#include "armature/task/procedure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace armature {

Procedure::Procedure(std::vector<Step> steps, bool auto_confirm)
    : steps_{std::move(steps)}, auto_confirm_{auto_confirm} {}

void Procedure::set_steps_ahead(std::vector<Step> steps) {
  steps_.resize(step_ + 1);
  std::ranges::move(steps, std::back_inserter(steps_));
}

void Procedure::enter(std::size_t step) {
  step_ = step;
  asks_ = steps_[step].asks && !auto_confirm_;
}

void Procedure::end(StepState how) {
  over_ = true;
  ended_ = how;
  asks_ = paused_ = false;
}

Procedure::StepState Procedure::state_of(std::size_t step) const {
  if (step != step_) return step < step_ ? StepState::done : StepState::ahead;
  if (asks()) return StepState::asks;
  return over_ ? ended_ : StepState::active;
}

Expected<OperatorWord> Procedure::hear(const OperatorCommand& command) {
  const auto word = std::ranges::find(kOperatorWords, command.word);
  if (word == std::end(kOperatorWords)) {
    return refuse(fmt::format("'{}' is no command; there are {}", command.word,
                              fmt::join(kOperatorWords, ", ")));
  }
  if (over_) return refuse("the procedure is over");
  const auto said = static_cast<OperatorWord>(word - std::begin(kOperatorWords));
  switch (said) {
    case OperatorWord::confirm:
      if (!asks_) return refuse("no step waits for its confirmation");
      if (command.step != steps_[step_].name) {
        return refuse(fmt::format("the step that waits for its confirmation is '{}', not '{}'",
                                  steps_[step_].name, command.step));
      }
      if (paused_) return refuse("it is paused: resume comes first");
      asks_ = false;
      break;
    case OperatorWord::pause:
      if (paused_) return refuse("it is paused already");
      paused_ = true;
      break;
    case OperatorWord::resume:
      if (!paused_) return refuse("it is not paused");
      paused_ = false;
      break;
    case OperatorWord::back:
    case OperatorWord::abort: break;
  }
  return said;
}

}  // namespace armature
