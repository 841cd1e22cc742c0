// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "stereo_fit.hpp"

namespace armature {

/// A calibration as OpenCV's FileStorage reads it, with `comment` (lines) at its top.
std::string opencv_text(const stereo::StereoCalibration& calibration, const std::string& comment);

/// The `mount:` of a rig file that is there; else a comment that says what is to be written. Throws
/// config::ConfigError where the file is no YAML.
std::string mount_text(const std::string& rig_file);

/// A rig file of the pair that a calibration gives, with the lines of its mount.
std::string rig_text(const StereoCamera& camera, const std::string& calibration_file,
                     const std::string& mount);

/// A picture (SVG) of both cameras' pictures with the corners that were found in them.
std::string coverage_svg(const std::vector<stereo::BoardView>& views, int width, int height);

/// Which part of a picture has corners, by 8 x 6 fields: 0 to 1.
double coverage(const std::vector<stereo::BoardView>& views,
                std::vector<Eigen::Vector2d> stereo::BoardView::*side, int width, int height);

}  // namespace armature
