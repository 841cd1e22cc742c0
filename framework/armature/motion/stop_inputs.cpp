// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/stop_inputs.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace armature {
namespace {

bool is_true(const msg::Bool& message) { return message.data_(); }

// Words of an arm's operating_state that are a stop, and those of CRTK that are one when it was
// enabled before.
constexpr std::array<std::string_view, 3> kStops{"protective_stop", "emergency_stop", "override"};
constexpr std::array<std::string_view, 3> kNotEnabled{"disabled", "paused", "fault"};
constexpr std::string_view kEnabled = "enabled";

/// Drivers write such words small or large.
bool is_same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// The one of `words` that it is, or empty.
std::string_view find_word(const std::array<std::string_view, 3>& words, std::string_view state) {
  const auto found =
      std::ranges::find_if(words, [&](std::string_view word) { return is_same_word(word, state); });
  return found == words.end() ? std::string_view{} : *found;
}

}  // namespace

StopInputs::StopInputs(Setup& setup, Duration operator_timeout)
    : stop_{setup.input_if<msg::Bool, is_true>("stop")},
      rearm_{setup.input_if<msg::Bool, is_true>("rearm")},
      hold_to_run_{setup.input<msg::Bool>("hold_to_run"), setup.is_written("hold_to_run"),
                   "hold_to_run", "hold_to_run was released"},
      operator_present_{setup.input<msg::Bool>("operator_present"),
                        setup.is_written("operator_present"), "operator_present",
                        "the operator is not present"},
      operating_state_{setup.input<msg::String>("operating_state")},
      timeout_{operator_timeout} {}

void StopInputs::hear(Enable& enable) {
  if (enable.input.size() == 0) return;
  enable.holds = true;
  for (std::size_t i = 0; i < enable.input.size(); ++i) {
    enable.holds = enable.holds && enable.input[i].data_();
    enable.told_at = enable.input.info(i).published;
  }
}

ReasonText StopInputs::missing(const Enable& enable, Time now) const {
  if (!enable.is_written) return {};
  if (!enable.told_at) return ReasonText::format("{} has not been told yet", enable.name);
  const Duration age = now - *enable.told_at;
  if (age > timeout_) {
    return ReasonText::format("{} is silent for {:.2f} s (operator_timeout_s is {:g})", enable.name,
                              to_seconds(age), to_seconds(timeout_));
  }
  return enable.holds ? ReasonText{} : ReasonText{enable.released};
}

std::string_view StopInputs::stop_word(std::string_view state) {
  was_enabled_ = was_enabled_ || is_same_word(state, kEnabled);
  const std::string_view stop = find_word(kStops, state);
  return stop.empty() && was_enabled_ ? find_word(kNotEnabled, state) : stop;
}

std::string_view StopInputs::hear_arm() {
  std::string_view said = stop_word_;
  for (std::size_t i = 0; i < operating_state_.size(); ++i) {
    stop_word_ = stop_word(operating_state_[i].data_());
    if (said.empty()) said = stop_word_;
  }
  return operating_state_.size() == 0 ? stop_word_ : said;
}

StopCause StopInputs::cause(Time now) {
  hear(hold_to_run_);
  hear(operator_present_);
  const std::string_view arm = hear_arm();
  const bool by_arm = !arm.empty();
  if (stop_.size() > 0) return {.why = "a stop was asked for on the topic /stop", .by_arm = by_arm};
  if (by_arm) return {.why = ReasonText::format("the arm says {}", arm), .by_arm = true};
  ReasonText why = missing(hold_to_run_, now);
  if (why.empty()) why = missing(operator_present_, now);
  return {.why = why, .wants_operator = !why.empty()};
}

bool StopInputs::rearmed() const { return rearm_.size() > 0; }

}  // namespace armature
