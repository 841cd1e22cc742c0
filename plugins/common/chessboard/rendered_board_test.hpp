// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "chessboard.hpp"
#include "lens.hpp"

// A chessboard before a camera that is known exactly, for the tests.
namespace armature::chessboard {

/// A camera that draws boards. The board's frame: first inner corner at the origin, x along the
/// rows, y down, z away from who looks at it; the first square between corners is black.
class BoardCamera {
 public:
  BoardCamera(const stereo::Lens& lens, int width, int height)
      : lens_{lens}, width_{width}, height_{height} {
    const double max = lens.max_radius();
    for (int v = 0; v <= height; ++v) {
      for (int u = 0; u <= width; ++u) {
        rays_.push_back(lens.ray_of({u - 0.5, v - 0.5}, max).value_or(Eigen::Vector2d{1e3, 1e3}));
      }
    }
  }

  /// 3 x 3 samples a pixel, and Gaussian noise of `noise` grey values by `seed`.
  std::vector<std::uint8_t> picture(const Eigen::Isometry3d& camera_T_board,
                                    const BoardShape& shape, double square_m, double noise,
                                    std::uint64_t seed) const {
    std::mt19937_64 random{seed};
    std::normal_distribution<double> grey{0, 1};
    std::vector<std::uint8_t> pixels;
    pixels.reserve(static_cast<std::size_t>(width_ * height_));
    const Eigen::Isometry3d board_T_camera = camera_T_board.inverse();
    for (int v = 0; v < height_; ++v) {
      for (int u = 0; u < width_; ++u) {
        double sum = 0;
        for (int i = 0; i < 9; ++i) {
          const Eigen::Vector2d ray = ray_at(u, v, (i % 3 + 0.5) / 3, (i / 3 + 0.5) / 3);
          sum += brightness(board_T_camera, ray, shape, square_m);
        }
        const double value = sum / 9 + noise * grey(random);
        pixels.push_back(static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L)));
      }
    }
    return pixels;
  }

  /// Where the camera sees the corners, row by row.
  std::vector<Eigen::Vector2d> corners(const Eigen::Isometry3d& camera_T_board,
                                       const BoardShape& shape, double square_m) const {
    std::vector<Eigen::Vector2d> all;
    for (int row = 0; row < shape.rows; ++row) {
      for (int column = 0; column < shape.columns; ++column) {
        const Eigen::Vector3d point{column * square_m, row * square_m, 0};
        all.push_back(lens_.project((camera_T_board * point).hnormalized()));
      }
    }
    return all;
  }

 private:
  Eigen::Vector2d ray_at(int u, int v, double a, double b) const {
    const auto at = static_cast<std::size_t>(v * (width_ + 1) + u);
    const auto below = at + static_cast<std::size_t>(width_ + 1);
    return (1 - b) * ((1 - a) * rays_[at] + a * rays_[at + 1]) +
           b * ((1 - a) * rays_[below] + a * rays_[below + 1]);
  }

  static double brightness(const Eigen::Isometry3d& board_T_camera, const Eigen::Vector2d& ray,
                           const BoardShape& shape, double square_m) {
    constexpr double kWall = 110, kPaper = 210, kBlack = 30;
    const Eigen::Vector3d from = board_T_camera.translation();
    const Eigen::Vector3d way = board_T_camera.linear() * ray.homogeneous();
    const double x = (from.x() - way.x() * from.z() / way.z()) / square_m;
    const double y = (from.y() - way.y() * from.z() / way.z()) / square_m;
    if (x < -2 || y < -2 || x > shape.columns + 1 || y > shape.rows + 1) return kWall;
    if (x < -1 || y < -1 || x > shape.columns || y > shape.rows) return kPaper;
    const int square = static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(y));
    return square % 2 == 0 ? kBlack : kPaper;
  }

  stereo::Lens lens_;
  int width_, height_;
  std::vector<Eigen::Vector2d> rays_;  // of the corners of pixels
};

}  // namespace armature::chessboard
