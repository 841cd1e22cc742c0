// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "armature/values/time.hpp"

namespace armature::task::implant {

/// What the tracker said of a body.
struct Sighting {
  Time stamp;                                       // of the light
  std::optional<Eigen::Isometry3d> tracker_T_body;  // none: not seen
  std::string reason = {};                          // why not
};

/// Whether a body that is needed is still seen. A sample counts once: one whose stamp is not newer
/// is the last one again. A tracker that errs never gives two equal poses, so once it has been seen
/// to err, a pose that equals the last one bit for bit is no sight of the body but a tracker, or
/// its driver, that is frozen.
class BodyWatch {
 public:
  /// `body` as in "the tracker has not seen the jaw".
  BodyWatch(std::string body, Duration timeout) : body_{std::move(body)}, timeout_{timeout} {}

  /// From now on it has to be seen.
  void begin(Time now);
  /// Whether the body was seen anew. `rests`: what carries it has not moved since the last sample,
  /// as far as one knows; a body that is carried on does not keep its pose, however well it is
  /// seen.
  bool see(const Sighting& sighting, bool rests = true);
  /// "the tracker has not seen the jaw for 0.52 s: its spheres are hidden", or nullopt. A light
  /// that is stamped too far ahead of `now` is none.
  std::optional<std::string> blind(Time now) const;

 private:
  bool varies() const;
  /// Counts samples in a row that differ a little although the body rests.
  void watch_noise(const Eigen::Isometry3d& tracker_T_body, bool rests);

  std::string body_;
  Duration timeout_;
  Time last_;
  std::optional<Sighting> newest_;  // of those that were seen anew
  int differing_ = 0;               // in a row
  std::string reason_;
};

}  // namespace armature::task::implant
