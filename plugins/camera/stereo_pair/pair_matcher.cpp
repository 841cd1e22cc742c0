// SPDX-License-Identifier: Apache-2.0
#include "pair_matcher.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace armature::camera::stereo_pair {

void PairMatcher::add(Side side, StampedPicture picture) {
  std::deque<StampedPicture>& waiting = of(side);
  if (!waiting.empty() && picture.stamp <= waiting.back().stamp) {
    while (!waiting.empty()) drop_oldest(side);
  }
  std::optional<Rhythm>& rhythm = rhythms_[static_cast<std::size_t>(side)];
  if (rhythm && picture.stamp > rhythm->newest) {
    const Duration passed = picture.stamp - rhythm->newest;
    rhythm->interval = std::min(passed, std::exchange(rhythm->before, passed).value_or(passed));
    rhythm->newest = picture.stamp;
  } else {
    rhythm = {.newest = picture.stamp, .before = {}, .interval = {}};
  }
  if (waiting.size() == kMaxWaiting) drop_oldest(side);
  waiting.push_back(std::move(picture));
}

void PairMatcher::drop_oldest(Side side) {
  const Side other_side = side == Side::left ? Side::right : Side::left;
  const Time stamp = of(side).front().stamp;
  last_distance_.reset();
  const auto consider = [&](Time other) {
    const Duration distance = std::chrono::abs(other - stamp);
    last_distance_ = std::min(last_distance_.value_or(distance), distance);
  };
  for (const StampedPicture& other : of(other_side)) consider(other.stamp);
  const auto& gone = last_gone_[static_cast<std::size_t>(other_side)];
  if (gone) consider(*gone);
  last_gone_[static_cast<std::size_t>(side)] = stamp;
  of(side).pop_front();
  ++unpaired_;
}

/// `distance`: of the oldest picture of the other camera from the one that waits of `older`.
bool PairMatcher::may_nearer_come(Side older, Duration distance) {
  const auto& rhythm = rhythms_[static_cast<std::size_t>(older)];
  const bool both_newest = of(Side::left).size() == 1 && of(Side::right).size() == 1;
  return both_newest && rhythm->interval && 2 * distance > *rhythm->interval;
}

std::optional<MatchedPair> PairMatcher::next() {
  std::deque<StampedPicture>&left = of(Side::left), &right = of(Side::right);
  while (!left.empty() && !right.empty()) {
    const Duration ahead = right.front().stamp - left.front().stamp;
    const Side older = ahead > Duration{0} ? Side::left : Side::right;
    const Time newer_stamp = std::max(left.front().stamp, right.front().stamp);
    const bool has_nearer =
        of(older).size() > 1 &&
        std::chrono::abs(of(older)[1].stamp - newer_stamp) < std::chrono::abs(ahead);
    if (std::chrono::abs(ahead) > max_skew_ || has_nearer) {
      drop_oldest(older);
      continue;
    }
    if (may_nearer_come(older, std::chrono::abs(ahead))) break;
    MatchedPair pair{std::move(left.front()), std::move(right.front())};
    last_gone_ = {pair.left.stamp, pair.right.stamp};
    left.pop_front();
    right.pop_front();
    return pair;
  }
  return std::nullopt;
}

}  // namespace armature::camera::stereo_pair
