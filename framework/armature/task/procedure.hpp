// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// What an operator says to a task.
enum class OperatorWord { confirm, pause, resume, back, abort };

inline constexpr std::string_view kOperatorWords[] = {"confirm", "pause", "resume", "back",
                                                      "abort"};

/// Whether a word only takes risk away: it is obeyed however it was told.
inline bool makes_safe(std::string_view word) { return word == "pause" || word == "abort"; }

/// An operator's word, as it was told.
struct OperatorCommand {
  std::uint64_t id = 0;
  std::string word;
  std::string step = {};  // which one is confirmed
};

/// The named steps of a task, which of them it is at, and what the operator may say to it. A step
/// that asks is not begun before it was confirmed by its name: a word that comes late confirms
/// nothing else. What a word means for the arm is the task's.
class Procedure {
 public:
  enum class StepState : std::uint8_t { ahead = 0, asks, active, done, broken_off };
  struct Step {
    std::string name;
    bool asks = false;  // it moves towards the patient
  };

  /// `auto_confirm`: nobody is asked. At the first step, which must not ask.
  Procedure(std::vector<Step> steps, bool auto_confirm);

  /// The steps behind the one that it is at, once they are known.
  void set_steps_ahead(std::vector<Step> steps);

  /// Comes to a step, forwards or back. One that asks waits for the operator.
  void enter(std::size_t step);
  void enter_next() { enter(step_ + 1); }
  /// It is over: no step waits, and no word is heard. The step that it is at is done, or broken
  /// off.
  void end(StepState how = StepState::done);

  const std::vector<Step>& steps() const { return steps_; }
  std::size_t step() const { return step_; }
  StepState state_of(std::size_t step) const;
  bool is_last() const { return step_ + 1 == steps_.size(); }
  /// The step that it is at waits for the operator.
  bool asks() const { return !over_ && asks_; }
  /// The task may do what the step says.
  bool may_act() const { return !over_ && !asks_ && !paused_; }
  bool paused() const { return paused_; }
  bool over() const { return over_; }
  bool auto_confirm() const { return auto_confirm_; }

  /// What of the word holds here: a confirmed step is active then, a task paused or not paused. Or
  /// why it is refused, with what could be said instead. `back` and `abort` are the task's to obey
  /// or to refuse.
  Expected<OperatorWord> hear(const OperatorCommand& command);
  /// The task obeys `back` or `abort`: nothing is paused, and the step that it leaves asks nothing.
  void turn_back() { paused_ = asks_ = false; }

 private:
  std::vector<Step> steps_;
  std::size_t step_ = 0;
  bool auto_confirm_, asks_ = false, paused_ = false;
  bool over_ = false;
  StepState ended_ = StepState::done;
};

}  // namespace armature
