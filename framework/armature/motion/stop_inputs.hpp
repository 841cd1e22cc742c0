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
  bool wants_operator = false;  // nobody stopped it, and nobody has enabled it
  bool by_arm = false;          // which says that it does not follow
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
  /// The arm's word for a stop, or empty.
  std::string_view hear_arm();
  std::string_view stop_word(std::string_view state);

  Input<msg::Bool> stop_, rearm_;
  Enable hold_to_run_, operator_present_;
  Input<msg::String> operating_state_;
  std::string_view stop_word_;  // that the arm said last, if it was one for a stop
  bool was_enabled_ = false;    // the arm, at some time
  Duration timeout_;
};

}  // namespace armature
