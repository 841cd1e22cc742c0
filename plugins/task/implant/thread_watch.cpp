// SPDX-License-Identifier: Apache-2.0
#include "thread_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace armature::task::implant {

void ThreadWatch::see(double angle, Time now) {
  angle_ = angle;
  heard_ = now;
}

void ThreadWatch::engage(const Thread& thread, Time now) {
  thread_ = thread;
  begun_at_ = angle_.value_or(0);
  heard_ = std::max(heard_, now);
}

std::optional<std::string> ThreadWatch::trouble(const Eigen::Vector3d& tool, Time now) const {
  if (!thread_) return std::nullopt;
  if (now - heard_ > seconds(parameters_.timeout)) {
    return fmt::format("the handpiece has not told for {:.2f} s how far it has turned",
                       to_seconds(now - heard_));
  }
  const double turned = angle_.value_or(0) - begun_at_;
  if (!std::isfinite(turned)) {
    return fmt::format("what the handpiece tells of how far it has turned is no number: {:g} rad",
                       std::isfinite(begun_at_) ? *angle_ : begun_at_);
  }
  const double advance_m = thread_->advance_m(tool);
  if (std::abs(thread_->ahead_m(tool, turned)) <= parameters_.max_thread_error) return std::nullopt;
  return fmt::format(
      "the implant went in by {:.2f} mm, and was turned by {:.2f} of the {:.2f} turns that its "
      "thread wants; {:g} mm off are allowed",
      1e3 * advance_m, turned / (2 * std::numbers::pi), advance_m / thread_->pitch_m,
      1e3 * parameters_.max_thread_error);
}

}  // namespace armature::task::implant
