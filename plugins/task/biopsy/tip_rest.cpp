// SPDX-License-Identifier: Apache-2.0
#include "tip_rest.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace armature::task::biopsy {
namespace {

constexpr Duration kMaxGap = seconds(0.1);

}  // namespace

TipRest::TipRest(Duration window, double max_spread) : window_{window}, max_spread_{max_spread} {}

void TipRest::see(const Eigen::Vector3d& tip, Time stamp) {
  if (!samples_.empty()) {
    const Duration step = stamp - samples_.back().stamp;
    if (step == Duration{}) return;
    if (step < Duration{} || step > kMaxGap) samples_.clear();
  }
  samples_.push_back({tip, stamp});
  while (samples_.size() > 1 && stamp - samples_[1].stamp >= window_) samples_.pop_front();
}

bool TipRest::full() const {
  return !samples_.empty() && samples_.back().stamp - samples_.front().stamp >= window_;
}

Eigen::Vector3d TipRest::mean() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Sample& sample : samples_) sum += sample.tip;
  return sum / static_cast<double>(samples_.size());
}

double TipRest::spread() const {
  const Eigen::Vector3d middle = mean();
  double farthest = 0;
  for (const Sample& sample : samples_) {
    farthest = std::max(farthest, (sample.tip - middle).norm());
  }
  return farthest;
}

bool TipRest::moves() const { return full() && !(spread() <= max_spread_); }

Expected<Eigen::Vector3d> TipRest::place(Time now) const {
  if (samples_.empty()) return refuse("the arm has not told yet where it is");
  const Duration age = now - samples_.back().stamp;
  if (age < -kMaxGap) {
    return refuse(
        fmt::format("the arm's stamps are {:.2f} s ahead of this clock", -to_seconds(age)));
  }
  if (age > kMaxGap) {
    return refuse(fmt::format("the arm has not told for {:.2f} s where it is", to_seconds(age)));
  }
  if (!full()) {
    return refuse(fmt::format(
        "the tip has been seen for {:.2f} s only, {:g} s are required "
        "(touch_rest_s)",
        to_seconds(samples_.back().stamp - samples_.front().stamp), to_seconds(window_)));
  }
  if (moves()) {
    return refuse(
        fmt::format("the tip was up to {:.2f} mm from its mean place within {:g} s, {:g} "
                    "mm are allowed (max_touch_spread_mm): hold it still",
                    1e3 * spread(), to_seconds(window_), 1e3 * max_spread_));
  }
  return mean();
}

}  // namespace armature::task::biopsy
