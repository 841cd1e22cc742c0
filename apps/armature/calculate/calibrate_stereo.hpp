// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace armature {

struct StereoCalibrationOptions {
  std::string left, right;    // folders with pictures
  std::vector<int> board;     // inner corners along its rows, and along its columns
  double square_mm = 0;       // side of a square
  std::string output;         // OpenCV's YAML file to write
  std::string rig, coverage;  // a rig file and a picture (SVG) to write; empty: none
  bool with_k3 = false;       // of the distortion
  bool json = false;
};

/// `armature calibrate stereo`: hands over to armature-calibrate-stereo, which stands beside this
/// program, as what reads pictures would make every other verb start later. Returns only when that
/// program is not there, with the reason on standard error.
int run_stereo_calibration(const StereoCalibrationOptions& options);

}  // namespace armature
