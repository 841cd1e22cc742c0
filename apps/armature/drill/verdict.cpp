// SPDX-License-Identifier: Apache-2.0
#include "drill/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace armature::drill {
namespace {

/// What is wrong with one arm, or nothing.
std::string fault_of(const std::string& name, const ArmRecord& record, Arrival stop, bool lost) {
  if (const auto fast = record.beyond_limit()) {
    return fmt::format("'{}' was beyond its limits: joint {} at {:.2f} /s", name, fast->joint,
                       fast->speed);
  }
  const auto end = record.speed_at_end();
  if (!end) return fmt::format("'{}' was not heard", name);
  if (lost) return {};
  if (!rests(end->speed)) {
    return fmt::format("'{}' was still moving at its end: joint {} at {:.2g} /s", name, end->joint,
                       end->speed);
  }
  if (const auto again = record.moved_again(stop)) {
    return fmt::format("'{}' moved again after it had come to rest: joint {} at {:.2g} /s", name,
                       again->joint, again->speed);
  }
  return {};
}

}  // namespace

Verdict judge(const std::vector<DrilledArm>& arms, const std::vector<ArmRecord>& records,
              Arrival stop, const std::string& lost) {
  Verdict verdict;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    const bool is_lost = arms[i].component == lost;
    const std::string wrong = fault_of(arms[i].component, records[i], stop, is_lost);
    if (verdict.wrong.empty()) verdict.wrong = wrong;
    if (is_lost) continue;
    verdict.rest_s = std::max(verdict.rest_s, to_seconds(records[i].time_to_rest(stop)));
  }
  if (!verdict.wrong.empty()) {
    verdict.arm = verdict.wrong;
  } else if (verdict.rest_s > 0) {
    verdict.arm = fmt::format("ramped to rest in {:.2f} s", verdict.rest_s);
  } else {
    verdict.arm = lost.empty() || arms.size() > 1 ? "was at rest" : "ended with its driver";
  }
  return verdict;
}

}  // namespace armature::drill
