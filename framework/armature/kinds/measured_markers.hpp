// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <optional>
#include <string>
#include <string_view>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"

namespace armature ARMATURE_EXPORT {

/// Why markers that somebody measured cannot be registered, or nullopt: they are not stated in
/// `frame`, so that nobody knows where they are, or their expected error is none.
/// "the markers are stated in frame 'camera', not in 'base'".
inline std::optional<std::string> wrong_with(const msg::MeasuredMarkers& markers,
                                             std::string_view frame) {
  if (auto wrong = not_in_frame(markers.header_(), frame, "the markers are")) return wrong;
  if (const double error_m = markers.error_(); !(error_m >= 0)) {
    return fmt::format(
        "the error of the markers is stated as {:g} mm; state how far each is expected to be off, "
        "or 0 when that is not known",
        1e3 * error_m);
  }
  return std::nullopt;
}

}  // namespace armature
