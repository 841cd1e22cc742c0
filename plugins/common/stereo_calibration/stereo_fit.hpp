// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "armature/values/expected.hpp"
#include "stereo_calibration.hpp"

namespace armature::stereo {

/// What both cameras see of a flat board that is held before them: its points in the pictures [px],
/// in the order of the board's own.
struct BoardView {
  std::vector<Eigen::Vector2d> left, right;
  std::string name;  // of the pair
};

struct FitOptions {
  int width = 0, height = 0;  // [px] of all pictures
  bool with_k3 = false;       // else k1, k2, p1 and p2 only
};

/// How sure a number is: its standard deviation, from the residuals.
struct FitErrors {
  double focal_px = 0;    // the greatest of the four focal lengths
  double centre_px = 0;   // the greatest of the principal points' coordinates
  double baseline_m = 0;  // of the distance between the cameras
  double rotation = 0;    // [rad] the greatest about an axis, of one camera against the other
};

struct StereoFit {
  StereoCalibration calibration;
  std::vector<Eigen::Isometry3d> left_T_board;  // of each view
  double left_rms_px = 0, right_rms_px = 0;     // of what is left
  double alone_rms_px = 0;          // the same of both, where neither knows of the other
  std::vector<double> view_rms_px;  // of both cameras
  FitErrors errors;
};

/// Lenses and posture of two cameras that least squares give, from views of a flat board whose
/// points are `board` [m]. It begins with the focal length that makes the views' homographies those
/// of rigid motions (Zhang, IEEE PAMI 22(11), 2000, section 3.1, with square pixels and the
/// principal point in the middle), and with five others, as a bent lens may hide it; then comes
/// Levenberg-Marquardt for each camera, and for both together. Refuses fewer than three views,
/// those by which the right camera is far from where it is by the others, by name, views by which
/// a focal length is not known to 5 %, and what does not converge. Not real-time safe.
Expected<StereoFit> fit_stereo(const std::vector<Eigen::Vector2d>& board,
                               const std::vector<BoardView>& views, const FitOptions& options);

}  // namespace armature::stereo
