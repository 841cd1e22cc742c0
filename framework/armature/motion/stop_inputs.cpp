// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/stop_inputs.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>

#include "armature/values/utf8.hpp"
#include "armature/values/without_blanks.hpp"

namespace armature {
namespace {

bool is_true(const msg::Bool& message) { return message.data_(); }

// Words of an arm's operating_state: those that are a stop, those of CRTK that are one when it was
// enabled before, and those that are none.
constexpr std::array<std::string_view, 3> kStops{"protective_stop", "emergency_stop", "override"};
constexpr std::array<std::string_view, 3> kNotEnabled{"disabled", "paused", "fault"};
constexpr std::string_view kEnabled = "enabled";
constexpr std::string_view kHolding = "holding";

constexpr std::size_t kToldOfAWord = 40;  // bytes

/// Drivers write such words small or large, "emergency-stop" or "Emergency Stop".
bool is_same_word(std::string_view word, std::string_view said) {
  return std::ranges::equal(word, without_blanks(said), [](unsigned char a, unsigned char b) {
    return a == (b == '-' || b == ' ' ? '_' : std::tolower(b));
  });
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

ReasonText StopInputs::stop_of(std::string_view state) {
  unknown_word_.clear();
  enabled_ = is_same_word(kEnabled, state);
  was_enabled_ = was_enabled_ || enabled_;
  follows_nothing_ = false;
  if (enabled_ || is_same_word(kHolding, state)) return {};
  const std::string_view stop = find_word(kStops, state), lost = find_word(kNotEnabled, state);
  follows_nothing_ = !stop.empty() || !lost.empty();
  if (!stop.empty()) return ReasonText::format("the arm says {}", stop);
  if (lost.empty()) {
    unknown_word_ = ReasonText::format(
        "the arm says '{}', which is none of ENABLED, HOLDING, DISABLED, PAUSED, FAULT, "
        "PROTECTIVE_STOP, EMERGENCY_STOP and OVERRIDE",
        beginning_of(without_blanks(state), kToldOfAWord));
    return was_enabled_ ? unknown_word_ : ReasonText{};
  }
  return was_enabled_ ? ReasonText::format("the arm says {}", lost) : ReasonText{};
}

ReasonText StopInputs::hear_arm() {
  ReasonText said = stop_of_arm_;
  for (std::size_t i = 0; i < operating_state_.size(); ++i) {
    stop_of_arm_ = stop_of(operating_state_[i].data_());
    if (said.empty()) said = stop_of_arm_;
  }
  return operating_state_.size() == 0 ? stop_of_arm_ : said;
}

StopCause StopInputs::cause(Time now) {
  hear(hold_to_run_);
  hear(operator_present_);
  const ReasonText arm = hear_arm();
  StopCause cause;
  if (!arm.empty() || follows_nothing_) {
    cause.follows = false;
  } else if (enabled_) {
    cause.follows = true;
  }
  if (stop_.size() > 0) {
    cause.why = "a stop was asked for on the topic /stop";
  } else if (!arm.empty()) {
    cause.why = arm;
  } else {
    cause.why = missing(hold_to_run_, now);
    if (cause.why.empty()) cause.why = missing(operator_present_, now);
    cause.wants_operator = !cause.why.empty();
  }
  return cause;
}

bool StopInputs::rearmed() const { return rearm_.size() > 0; }

}  // namespace armature
