// SPDX-License-Identifier: Apache-2.0
#include "sighting.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace armature::task::implant {
namespace {

constexpr const char* kSilent = "it sends nothing";
constexpr const char* kFrozen = "it gives the same pose again and again";

/// An arm that comes to rest is seen to do so by fewer samples, or by less.
constexpr int kDiffering = 10;
constexpr double kNoNoise = 1e-7;  // [m] far below what a tracker errs by
constexpr double kMotion = 5e-4;   // [m] from sample to sample: more is a body that moves

bool is_same(const Eigen::Isometry3d& pose, const Eigen::Isometry3d& as) {
  return pose.matrix() == as.matrix();
}

}  // namespace

void BodyWatch::begin(Time now) {
  last_ = now;
  reason_ = kSilent;
}

bool BodyWatch::varies() const { return differing_ >= kDiffering; }

void BodyWatch::watch_noise(const Eigen::Isometry3d& tracker_T_body, bool rests) {
  if (!newest_ || varies()) return;
  const double off_m =
      (tracker_T_body.translation() - newest_->tracker_T_body->translation()).norm();
  const bool is_noise = rests && off_m > kNoNoise && off_m < kMotion;
  differing_ = is_noise ? differing_ + 1 : 0;
}

bool BodyWatch::see(const Sighting& sighting, bool rests) {
  if (!sighting.tracker_T_body) {
    reason_ = sighting.reason;
    return false;
  }
  if (newest_ && sighting.stamp <= newest_->stamp) return false;
  const bool frozen = newest_ && is_same(*sighting.tracker_T_body, *newest_->tracker_T_body) &&
                      (varies() || !rests);
  if (frozen) {
    reason_ = kFrozen;
    return false;
  }
  watch_noise(*sighting.tracker_T_body, rests);
  newest_ = sighting;
  last_ = std::max(last_, sighting.stamp);
  reason_ = kSilent;
  return true;
}

std::optional<std::string> BodyWatch::blind(Time now) const {
  if (last_ - now > timeout_) {
    return fmt::format("the tracker stamps {} {:.2f} s ahead of this clock", body_,
                       to_seconds(last_ - now));
  }
  if (now - last_ <= timeout_) return std::nullopt;
  return fmt::format("the tracker has not seen {} for {:.2f} s: {}", body_, to_seconds(now - last_),
                     reason_);
}

}  // namespace armature::task::implant
