// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "armature/bus/sample.hpp"
#include "armature/values/time.hpp"

namespace armature::camera::stereo_pair {

enum class Side { left, right };

struct StampedPicture {
  Time stamp;
  SampleRef picture;
};

struct MatchedPair {
  StampedPicture left, right;
  Duration skew() const { return std::chrono::abs(right.stamp - left.stamp); }
  /// Half way between both.
  Time stamp() const { return left.stamp + (right.stamp - left.stamp) / 2; }
};

/// Finds the pictures of two cameras that belong together: those whose stamps are nearest to each
/// other, and not farther apart than `max_skew`. Stamps of one camera rise; when they go back, its
/// clock was set, and what waits of it is dropped. At most kMaxWaiting pictures of a camera wait.
/// Where the next picture of a camera, by its rate, will be nearer than this one, the other picture
/// waits for it, at most until its own camera has sent the next.
class PairMatcher {
 public:
  static constexpr std::size_t kMaxWaiting = 8;

  explicit PairMatcher(Duration max_skew) : max_skew_{max_skew} {}

  void add(Side side, StampedPicture picture);
  /// The oldest pair that is complete.
  std::optional<MatchedPair> next();

  /// How many pictures have had no partner.
  std::uint64_t unpaired() const { return unpaired_; }
  /// How far away the nearest picture of the other camera was from the last one of them; nothing
  /// when there was none.
  std::optional<Duration> last_distance() const { return last_distance_; }

 private:
  std::deque<StampedPicture>& of(Side side) { return waiting_[static_cast<std::size_t>(side)]; }
  void drop_oldest(Side side);
  bool may_nearer_come(Side older, Duration distance);

  Duration max_skew_;
  std::array<std::deque<StampedPicture>, 2> waiting_;
  std::array<std::optional<Time>, 2> last_gone_;  // stamps of those that do not wait any more
  /// From picture to picture, the shorter one of the last two; at first nobody knows it.
  struct Rhythm {
    Time newest;
    std::optional<Duration> before, interval;
  };
  std::array<std::optional<Rhythm>, 2> rhythms_;
  std::uint64_t unpaired_ = 0;
  std::optional<Duration> last_distance_;
};

}  // namespace armature::camera::stereo_pair
