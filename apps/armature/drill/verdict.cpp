// SPDX-License-Identifier: Apache-2.0
#include "drill/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace armature::drill {
namespace {

Asked without_hand(Asked asked) {
  asked.held_until.reset();
  return asked;
}

/// What is wrong with one arm, or nothing.
std::string fault_of(const std::string& name, const ArmRecord& record, const Asked& asked) {
  if (const auto fast = record.beyond_limit()) {
    return fmt::format("'{}' was beyond its limits: joint {} at {:.2f} /s", name, fast->joint,
                       fast->speed);
  }
  const auto end = record.speed_at_end();
  if (!end) return fmt::format("'{}' was not heard", name);
  if (name == asked.lost) return {};
  if (!rests(end->speed)) {
    return fmt::format("'{}' was still moving at its end: joint {} at {:.2g} /s", name, end->joint,
                       end->speed);
  }
  if (asked.held_until) return fault_of(name, record.until(*asked.held_until), without_hand(asked));
  if (const auto held = asked.held_from ? record.moves_after(*asked.held_from) : std::nullopt) {
    return fmt::format("'{}' moved when it was to stay where it was: joint {} at {:.2g} /s", name,
                       held->joint, held->speed);
  }
  if (const auto again = record.moved_again(asked.stop)) {
    return fmt::format("'{}' moved again after it had come to rest: joint {} at {:.2g} /s", name,
                       again->joint, again->speed);
  }
  return {};
}

Duration time_to_rest(const ArmRecord& record, const Asked& asked) {
  if (!asked.held_until) return record.time_to_rest(asked.stop);
  return record.until(*asked.held_until).time_to_rest(asked.stop);
}

}  // namespace

Verdict judge(const std::vector<DrilledArm>& arms, const std::vector<ArmRecord>& records,
              const Asked& asked) {
  Verdict verdict;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const std::string wrong = fault_of(arms[i].component, records[i], asked);
    if (verdict.wrong.empty()) verdict.wrong = wrong;
    if (arms[i].component == asked.lost) continue;
    verdict.rest_s = std::max(verdict.rest_s, to_seconds(time_to_rest(records[i], asked)));
  }
  if (!verdict.wrong.empty()) {
    verdict.arm = verdict.wrong;
  } else if (verdict.rest_s > 0) {
    verdict.arm = fmt::format("ramped to rest in {:.2f} s", verdict.rest_s);
  } else {
    verdict.arm = asked.lost.empty() || arms.size() > 1 ? "was at rest" : "ended with its driver";
  }
  return verdict;
}

bool went_on(const std::vector<bool>& moved_at_fault, const std::vector<bool>& moved_after) {
  const auto any = [](const std::vector<bool>& arms) {
    return std::ranges::find(arms, true) != arms.end();
  };
  if (!any(moved_at_fault)) return any(moved_after);
  return std::ranges::equal(moved_at_fault, moved_after,
                            [](bool before, bool after) { return !before || after; });
}

std::string stood_still(const std::vector<DrilledArm>& arms,
                        const std::vector<bool>& moved_at_fault,
                        const std::vector<bool>& moved_after) {
  for (std::size_t i = 0; i < arms.size(); ++i) {
    if (moved_at_fault[i] && !moved_after[i]) {
      return fmt::format("'{}', which moved at the fault, did not go on", arms[i].component);
    }
  }
  return "no arm moved after the fault";
}

}  // namespace armature::drill
