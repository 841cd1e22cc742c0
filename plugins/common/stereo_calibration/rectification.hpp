// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "armature/values/expected.hpp"
#include "stereo_calibration.hpp"

namespace armature::stereo {

/// The rectification that a calibration says, or, where it says none, the one that turns both
/// cameras half way towards each other, and x along the baseline. Its focal length is the mean of
/// the four, and its principal point shows in the middle what the cameras have in the middle of
/// their pictures. Refuses, with numbers: cameras one above the other, behind each other or
/// exchanged; a baseline of more than 10 m or less than 1 mm (another unit); what the file says of
/// its rectification and of R and T where these do not agree within 0.2 degrees and 2 %; a size
/// that is not said.
Expected<Rectification> rectification_of(const StereoCalibration& calibration);

/// The pixel of a camera's own picture that is seen at `pixel` of its rectified one; nothing where
/// the camera's lens does not reach. `rectified_R_camera` is that of the camera. Real-time safe.
std::optional<Eigen::Vector2d> raw_pixel(const StereoCamera& rectified,
                                         const Eigen::Matrix3d& rectified_R_camera,
                                         const Lens& lens, double max_radius,
                                         const Eigen::Vector2d& pixel);

}  // namespace armature::stereo
