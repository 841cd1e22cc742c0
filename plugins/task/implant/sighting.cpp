// SPDX-License-Identifier: Apache-2.0
#include "sighting.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace armature::task::implant {
namespace {

constexpr const char* kSilent = "it sends nothing";

}  // namespace

void BodyWatch::begin(Time now) {
  last_ = now;
  reason_ = kSilent;
}

void BodyWatch::see(const Sighting& sighting) {
  if (!sighting.tracker_T_body) {
    reason_ = sighting.reason;
    return;
  }
  last_ = std::max(last_, sighting.stamp);
  reason_ = kSilent;
}

std::optional<std::string> BodyWatch::blind(Time now) const {
  if (now - last_ <= timeout_) return std::nullopt;
  return fmt::format("the tracker has not seen {} for {:.2f} s: {}", body_, to_seconds(now - last_),
                     reason_);
}

}  // namespace armature::task::implant
