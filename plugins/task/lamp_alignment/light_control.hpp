// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "armature/values/time.hpp"
#include "task_lamp_alignment_parameters.hpp"

namespace armature::task::lamp_alignment {

/// Brings the brightness of the picture into a band, one step of the light at a time: each picture
/// answers for the level before it (Jiang et al. 2021, section 2.3: compensate before measuring).
class LightControl {
 public:
  explicit LightControl(const Parameters& parameters)
      : parameters_{parameters}, level_{parameters.light_level} {}

  /// The new level, or nothing to change: the picture (taken at `stamp`, mean grey `intensity`) is
  /// in the band, is older than the last change, or the light is at its end.
  std::optional<double> update(Time stamp, double intensity, Time now) {
    if (stamp <= last_change_) return std::nullopt;
    const double wanted = intensity < parameters_.dark     ? level_ + parameters_.light_step
                          : intensity > parameters_.bright ? level_ - parameters_.light_step
                                                           : level_;
    const double next = std::clamp(wanted, 0.0, 1.0);
    if (next == level_) return std::nullopt;
    level_ = next;
    last_change_ = now;
    return level_;
  }

  /// True when the picture tells about the present level.
  bool answers(Time stamp) const { return stamp > last_change_; }
  double level() const { return level_; }
  /// What the light cannot mend of a picture that answers, or "".
  std::string end(double intensity) const {
    if (intensity < parameters_.dark && level_ >= 1) {
      return "the pictures are too dark, and the light is at its brightest";
    }
    if (intensity > parameters_.bright && level_ <= 0) {
      return "the pictures are too bright, and the light is off";
    }
    return {};
  }

 private:
  Parameters parameters_;
  double level_;
  Time last_change_{std::numeric_limits<std::int64_t>::min()};
};

}  // namespace armature::task::lamp_alignment
