// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/messages/builtin_interfaces.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// A message's stamp as an instant of the deployment's clock. Real-time safe.
inline Time stamp_of(const msg::Time& stamp) {
  return Time{std::int64_t{stamp.sec_()} * 1'000'000'000 + std::int64_t{stamp.nanosec_()}};
}

/// Also before the epoch: nanosec counts up from the full second below. Real-time safe.
inline void set_stamp(msg::Time& stamp, Time time) {
  const std::int64_t remainder = time.ns % 1'000'000'000;
  const std::int64_t nanosec = remainder < 0 ? remainder + 1'000'000'000 : remainder;
  stamp.sec_(static_cast<std::int32_t>((time.ns - nanosec) / 1'000'000'000));
  stamp.nanosec_(static_cast<std::uint32_t>(nanosec));
}

inline Duration duration_of(const msg::Duration& duration) {
  return Duration{std::int64_t{duration.sec_()} * 1'000'000'000 +
                  std::int64_t{duration.nanosec_()}};
}

inline void set_duration(msg::Duration& message, Duration duration) {
  msg::Time parts;
  set_stamp(parts, Time{duration.count()});
  message.sec_(parts.sec_());
  message.nanosec_(parts.nanosec_());
}

}  // namespace armature
