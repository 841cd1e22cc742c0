// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/values/inline_text.hpp"

namespace armature {

/// Why an arm must stand; empty: it need not.
struct StopCause {
  ReasonText why;
  bool wants_operator = false;       // nobody stopped it, and nobody has enabled it
  std::optional<bool> follows = {};  // the arm, by its own word; nothing: it does not say
};

/// Who may stop an arm beside its own motion component, and who may let it go again. A stop stays:
/// what stopped the arm may be over, and still only an explicit rearm begins again. Real-time safe.
class StopInputs {
 public:
  /// `operator_timeout`: what is silent for longer does not hold.
  StopInputs(Setup& setup, Duration operator_timeout);

  /// Once per activation: why the arm must stop now. Of everything that was told since the one
  /// before: a stop that was over at once is one.
  StopCause cause(Time now);
  /// Whether this activation brought a rearm. It counts only when there is no cause to stop.
  bool rearmed() const;
  /// What the arm said last when that is no word of an operating_state; empty: it is one.
  const ReasonText& unknown_word() const { return unknown_word_; }

 private:
  /// An input that must be true and not silent wherever a component writes it.
  struct Enable {
    Input<msg::Bool> input;
    bool is_written;
    std::string_view name, released;
    std::optional<Time> told_at = {};
    bool holds = false;
  };
  static void hear(Enable& enable);
  ReasonText missing(const Enable& enable, Time now) const;
  /// Why what the arm says is a stop, or empty.
  ReasonText hear_arm();
  ReasonText stop_of(std::string_view state);

  Input<msg::Bool> stop_, rearm_;
  Enable hold_to_run_, operator_present_;
  Input<msg::String> operating_state_;
  ReasonText stop_of_arm_;                          // what the arm said last, if it was a stop
  bool enabled_ = false, follows_nothing_ = false;  // what the arm said last means that
  ReasonText unknown_word_;                         // the same, if it was none of the words
  bool was_enabled_ = false;                        // the arm, at some time
  Duration timeout_;
};

}  // namespace armature
