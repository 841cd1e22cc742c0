// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/setup.hpp"
#include "armature/values/inline_text.hpp"

namespace armature {

/// Who may stop an arm beside its own motion component, and who may let it go again. A stop stays:
/// what stopped the arm may be over, and still only an explicit rearm begins again. Real-time safe.
class StopInputs {
 public:
  explicit StopInputs(Setup& setup);

  /// Once per activation: why the arm must stop now, or empty.
  ReasonText cause(Time now) const;
  /// Whether this activation brought a rearm. It counts only when there is no cause to stop.
  bool rearmed() const;

 private:
  /// An input that must be true and not silent wherever a component writes it.
  struct Enable {
    Input<msg::Bool> input;
    bool is_written;
    std::string_view name, released;
  };
  ReasonText missing(const Enable& enable, Time now) const;

  Input<msg::Bool> stop_, rearm_;
  Enable hold_to_run_, operator_present_;
  Input<msg::String> operating_state_;
  Duration timeout_;
};

}  // namespace armature
