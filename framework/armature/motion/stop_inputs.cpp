// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/stop_inputs.hpp"

#include <algorithm>
#include <array>

namespace armature {
namespace {

bool any_true(const Input<msg::Bool>& input) {
  for (std::size_t i = 0; i < input.size(); ++i) {
    if (input[i].data_()) return true;
  }
  return false;
}

// Words of CRTK's operating_state that are a stop.
constexpr std::array<std::string_view, 3> kStops{"protective_stop", "emergency_stop", "override"};

}  // namespace

StopInputs::StopInputs(Setup& setup)
    : stop_{setup.input<msg::Bool>("stop")},
      rearm_{setup.input<msg::Bool>("rearm")},
      hold_to_run_{setup.input<msg::Bool>("hold_to_run"), setup.is_written("hold_to_run"),
                   "hold_to_run", "hold_to_run was released"},
      operator_present_{setup.input<msg::Bool>("operator_present"),
                        setup.is_written("operator_present"), "operator_present",
                        "the operator is not present"},
      operating_state_{setup.input<msg::String>("operating_state")},
      timeout_{seconds(setup.params().number("operator_timeout_s"))} {}

ReasonText StopInputs::missing(const Enable& enable, Time now) const {
  if (!enable.is_written) return {};
  const msg::Bool* told = enable.input.latest();
  if (!told) return ReasonText::format("{} has not been told yet", enable.name);
  const Duration age = now - enable.input.info(0).published;
  if (age > timeout_) {
    return ReasonText::format("{} is silent for {:.2f} s (operator_timeout_s is {:g})", enable.name,
                              to_seconds(age), to_seconds(timeout_));
  }
  return told->data_() ? ReasonText{} : ReasonText{enable.released};
}

ReasonText StopInputs::cause(Time now) const {
  if (any_true(stop_)) return "a stop was asked for on the topic /stop";
  if (const msg::String* state = operating_state_.latest()) {
    const auto found = std::ranges::find(kStops, std::string_view{state->data_()});
    if (found != kStops.end()) return ReasonText::format("the arm says {}", *found);
  }
  if (ReasonText why = missing(hold_to_run_, now); !why.empty()) return why;
  return missing(operator_present_, now);
}

bool StopInputs::rearmed() const { return any_true(rearm_); }

}  // namespace armature
