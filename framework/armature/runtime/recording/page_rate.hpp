// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// How many messages a second the page of a run shows of a topic, and of a camera.
inline constexpr double kMaxPageHz = 50;
inline constexpr double kMaxPagePictureHz = 2;

/// How often a message of this type (its ROS name) is kept for a page, in Hz. 0: not at all.
/// Nothing: every one, because each is about something else.
inline std::optional<double> page_rate_hz(std::string_view ros_type) {
  if (ros_type == "armature_msgs/msg/Activation") return 0;
  if (ros_type == "sensor_msgs/msg/Image" || ros_type == "sensor_msgs/msg/CompressedImage") {
    return kMaxPagePictureHz;
  }
  if (ros_type == "rcl_interfaces/msg/Log" || ros_type == "tf2_msgs/msg/TFMessage") {
    return std::nullopt;
  }
  return kMaxPageHz;
}

/// Passes the first message of each period, and of a topic that is slow on the average also those
/// that come together: one for each period before in which none came, up to a fifth of a second's.
/// Periods count from the epoch of the clock, so what was thinned once is not thinned more by the
/// same rate.
class Thinning {
 public:
  /// Nothing: everything passes. 0: nothing does.
  explicit Thinning(std::optional<double> hz) : hz_{hz} {}

  bool passes(Time at) {
    if (!hz_) return true;
    if (*hz_ == 0) return false;
    const auto period_ns = static_cast<std::int64_t>(1e9 / *hz_);
    const std::int64_t period = at.ns / period_ns;
    const auto max_spare = static_cast<std::int64_t>(*hz_ / 5);
    if (period == last_) return spare_ > 0 && spare_-- > 0;
    spare_ =
        last_ ? std::clamp<std::int64_t>(spare_ + period - *last_ - 1, 0, max_spare) : max_spare;
    last_ = period;
    return true;
  }

 private:
  std::optional<double> hz_;
  std::optional<std::int64_t> last_;
  std::int64_t spare_ = 0;
};

}  // namespace armature
