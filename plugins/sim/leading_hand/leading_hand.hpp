// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "armature/values/time.hpp"
#include "sim_leading_hand_parameters.hpp"
#include "tip_way.hpp"

namespace armature::sim::leading_hand {

/// What the task tells a hand.
struct Touches {
  bool wanted = false;  // the arm may be led, and markers are to be touched
  std::size_t taken = 0;
  bool by_itself = true;  // nobody confirms a touch: it is taken where the tip rests
};

/// Where a hand wants the tip. It takes hold when touches are wanted, goes to one marker after the
/// other, and back to where it took hold. A touch that the operator drops is made again.
class LeadingHand {
 public:
  /// `seed` decides the order, the errors of the touches and the tremor.
  LeadingHand(const Parameters& parameters, std::uint64_t seed);

  /// `markers`: where they are [m], in the base frame. Takes hold of a tip that is at `tip`.
  void take_hold(const std::vector<Eigen::Vector3d>& markers, const Eigen::Vector3d& tip, Time now);
  bool holds() const { return holds_; }
  void let_go() { holds_ = false; }

  /// Where the tip shall be now. `halted`: the hand comes to rest within 0.3 s, then it lets go.
  Eigen::Vector3d lead(const Touches& touches, bool halted, Time now);
  /// There is a marker left that it would touch.
  bool has_more(const Touches& touches);

 private:
  void heed(const Touches& touches);
  /// It has come to the end of its way.
  void rest(const Touches& touches, Time now);
  void begin_way(std::optional<std::size_t> visit);
  Eigen::Vector3d tremor(Time now) const;
  Eigen::Vector3d touch_error();
  std::vector<std::size_t> order_of(std::size_t markers);

  Parameters parameters_;
  std::mt19937_64 random_;
  std::array<double, 3> tremor_hz_, tremor_phase_;  // along each axis
  std::vector<Eigen::Vector3d> markers_;
  std::vector<std::size_t> order_;  // indices of markers_, one for each visit
  Eigen::Vector3d home_ = Eigen::Vector3d::Zero(), at_ = home_;
  bool holds_ = false;
  std::size_t visit_ = 0;                     // the one that it goes to, or makes
  std::size_t taken_ = 0, taken_before_ = 0;  // touches: now, and when its way began
  std::optional<std::size_t> towards_;        // a visit; none: home
  TipWay way_;
  double on_way_s_ = 0, pace_ = 1;  // of its own time
  std::optional<Time> rests_since_;
  Time led_at_;
};

}  // namespace armature::sim::leading_hand
