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

/// Whether a body that is needed is still seen.
class BodyWatch {
 public:
  /// `body` as in "the tracker has not seen the jaw".
  BodyWatch(std::string body, Duration timeout) : body_{std::move(body)}, timeout_{timeout} {}

  /// From now on it has to be seen.
  void begin(Time now);
  void see(const Sighting& sighting);
  /// "the tracker has not seen the jaw for 0.52 s: its spheres are hidden", or nullopt.
  std::optional<std::string> blind(Time now) const;

 private:
  std::string body_;
  Duration timeout_;
  Time last_;
  std::string reason_;
};

}  // namespace armature::task::implant
