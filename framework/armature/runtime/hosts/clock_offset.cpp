// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/hosts/clock_offset.hpp"

#include <algorithm>

namespace armature {

void ClockOffset::add(Time asked, Time told, Time answered) {
  const Duration round_trip = answered - asked;
  if (round_trip < Duration{0}) return;
  answers_.push_back({.offset = told - asked - round_trip / 2, .round_trip = round_trip});
  if (answers_.size() > kRemembered) answers_.pop_front();
}

std::optional<ClockOffset::Estimate> ClockOffset::estimate() const {
  const auto best = std::ranges::min_element(answers_, {}, &Estimate::round_trip);
  return best == answers_.end() ? std::nullopt : std::optional{*best};
}

}  // namespace armature
