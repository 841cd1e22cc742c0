// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

namespace armature::chessboard {

/// Where four squares may meet.
struct SaddlePoint {
  Eigen::Vector2d at;             // [px], to about half a pixel
  Eigen::Vector2d first, second;  // unit vectors along both edges
  float strength;
};

/// The strongest saddle points of a grey picture, strongest first, around which a ring is dark,
/// bright, dark and bright; at most `max_count`.
std::vector<SaddlePoint> saddle_points(const cv::Mat& gray, std::size_t max_count);

}  // namespace armature::chessboard
