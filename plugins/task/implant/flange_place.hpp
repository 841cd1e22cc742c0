// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>

#include "arm_rest.hpp"
#include "armature/calibration/hand_eye.hpp"
#include "pose_average.hpp"
#include "sighting.hpp"
#include "task_implant_parameters.hpp"

namespace armature::task::implant {

/// Whether the tracker sees the body on the flange where arm and hand-eye calibration say that it
/// is. A tracker that was knocked, or a body that slipped on the flange, is seen by nothing else:
/// the jaw looks as if it had always been there.
class FlangePlace {
 public:
  explicit FlangePlace(const Parameters& parameters) : parameters_{parameters} {}

  void calibrate(const HandEye& hand_eye) { hand_eye_ = hand_eye; }
  /// Once more from the first sample.
  void forget() { average_.clear(); }
  /// With where the flange is as the arm says at `now`, and how still one is that stands. Samples
  /// count while the arm stands still: one whose light is older than the arm's rest may show
  /// another place.
  void see(const Sighting& sighting, const Eigen::Isometry3d& base_T_flange, Time now,
           const Stillness& still);
  /// That were seen since the arm stands still.
  int samples() const { return average_.count(); }
  /// Where the body is by arm and calibration.
  Eigen::Isometry3d base_T_body() const { return base_T_flange_ * hand_eye_.flange_T_body; }
  /// How far off the body is at a point of the base frame [m] that is fixed to it, when it is more
  /// than max_flange_error, and more than the samples and the calibration's poses scatter; or
  /// nullopt. At least two samples.
  std::optional<std::string> defect(std::span<const Eigen::Vector3d> points) const;

 private:
  Parameters parameters_;
  HandEye hand_eye_;
  PoseAverage average_;
  Time still_since_;
  Eigen::Isometry3d base_T_flange_ = Eigen::Isometry3d::Identity();  // since then
};

}  // namespace armature::task::implant
