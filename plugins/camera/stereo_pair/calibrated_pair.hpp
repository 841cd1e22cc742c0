// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "armature/kinds/image_view.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/files/stereo_rig.hpp"
#include "armature/values/time.hpp"
#include "camera_stereo_pair_parameters.hpp"
#include "pair_matcher.hpp"
#include "rectifying_map.hpp"

namespace armature::camera::stereo_pair {

/// What is known of two cameras, and how their pictures are rectified with it.
class CalibratedPair {
 public:
  /// With a calibration the pictures are rectified, without one they are already, as the rig says.
  /// A rig beside a calibration must say the same pair. Throws SetupError or config::ConfigError.
  CalibratedPair(const Parameters& parameters, const std::optional<StereoRig>& rig);

  const StereoCamera& camera() const { return rectification_.camera; }
  /// `raw` has the size of camera().
  void rectify(Side side, const ImageView& raw, std::vector<std::uint8_t>& pixels) const;
  /// Of a rectified picture: no distortion, and in P[3] of the right one -f b.
  msg::CameraInfo info(Side side, Time stamp) const;
  /// One line for people.
  std::string description() const;

 private:
  stereo::Rectification rectification_;
  std::vector<RectifyingMap> maps_;  // left and right; empty: nothing is to be done
};

}  // namespace armature::camera::stereo_pair
