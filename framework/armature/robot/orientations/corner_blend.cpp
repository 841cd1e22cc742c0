// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/orientations/corner_blend.hpp"

#include <algorithm>

namespace armature {
namespace {

constexpr double kNoLength = 1e-12;  // of the whole: a line between two blends that touch

VectorCubic from_bezier(const Eigen::Vector3d& b0, const Eigen::Vector3d& b1,
                        const Eigen::Vector3d& b2, const Eigen::Vector3d& b3, double h) {
  VectorCubic cubic;
  cubic.c << b0, 3 / h * (b1 - b0), 3 / (h * h) * (b2 - 2 * b1 + b0),
      1 / (h * h * h) * (b3 - 3 * b2 + 3 * b1 - b0);
  return cubic;
}

/// Half of what a blend about each key lasts; nothing at both ends.
std::vector<double> half_durations(std::span<const double> u) {
  std::vector<double> half(u.size(), 0.0);
  for (std::size_t i = 1; i + 1 < u.size(); ++i) {
    half[i] = 0.5 * std::min(u[i] - u[i - 1], u[i + 1] - u[i]);
  }
  return half;
}

}  // namespace

CornerControls corner_controls(const Eigen::Vector3d& D, const Eigen::Vector3d& B,
                               const Eigen::Vector3d& E, const Eigen::Vector3d& at_D,
                               const Eigen::Vector3d& at_E) {
  CornerControls d;
  d[0] = D;
  d[6] = E;
  d[1] = D + at_D / 12;
  d[5] = E - at_E / 12;
  d[2] = 3 * d[1] - 2 * d[0];
  d[4] = 3 * d[5] - 2 * d[6];
  d[3] = (6 * B - d[2] - d[4]) / 4;
  return d;
}

std::array<VectorCubic, 4> cubics_of(const CornerControls& d, double duration) {
  // The Bezier points of the four spans, by inserting each inner knot twice.
  const Eigen::Vector3d b2 = (d[1] + d[2]) / 2, b4 = (2 * d[2] + d[3]) / 3;
  const Eigen::Vector3d b5 = (d[2] + 2 * d[3]) / 3, b7 = (2 * d[3] + d[4]) / 3;
  const Eigen::Vector3d b8 = (d[3] + 2 * d[4]) / 3, b10 = (d[4] + d[5]) / 2;
  const Eigen::Vector3d b3 = (b2 + b4) / 2, b6 = (b5 + b7) / 2, b9 = (b8 + b10) / 2;
  const double h = duration / 4;
  return {from_bezier(d[0], d[1], b2, b3, h), from_bezier(b3, b4, b5, b6, h),
          from_bezier(b6, b7, b8, b9, h), from_bezier(b9, b10, d[5], d[6], h)};
}

void append_line(std::vector<BlendPiece>& pieces, double start, std::size_t key,
                 const Eigen::Vector3d& from, const Eigen::Vector3d& slope) {
  BlendPiece& piece = pieces.emplace_back(BlendPiece{start, key, {}});
  piece.cubic.c.col(0) = from;
  piece.cubic.c.col(1) = slope;
}

void append_corner(std::vector<BlendPiece>& pieces, double start, std::size_t key,
                   const CornerControls& controls, double duration) {
  const auto cubics = cubics_of(controls, duration);
  for (std::size_t k = 0; k < cubics.size(); ++k) {
    pieces.push_back({start + duration / 4 * static_cast<double>(k), key, cubics[k]});
  }
}

std::vector<BlendPiece> blend_pieces(std::span<const Eigen::Vector3d> points,
                                     std::span<const Eigen::Vector3d> slopes,
                                     std::span<const double> u) {
  const std::vector<double> half = half_durations(u);
  const double no_length = kNoLength * (u.back() - u.front());
  std::vector<BlendPiece> pieces;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    const Eigen::Vector3d &key = points[i], &behind = slopes[i];
    if (i > 0) {
      const Eigen::Vector3d& before = slopes[i - 1];
      const double duration = 2 * half[i];
      append_corner(pieces, u[i] - half[i], i,
                    corner_controls(key - half[i] * before, key, key + half[i] * behind,
                                    duration * before, duration * behind),
                    duration);
    }
    const double line = u[i] + half[i];
    if (u[i + 1] - half[i + 1] - line > no_length) {
      append_line(pieces, line, i, key + half[i] * behind, behind);
    }
  }
  return pieces;
}

std::size_t piece_at(std::span<const double> starts, double u) {
  const auto next = std::upper_bound(starts.begin() + 1, starts.end(), u);
  return static_cast<std::size_t>(next - starts.begin()) - 1;
}

BlendedPolyline::BlendedPolyline(std::span<const Eigen::Vector3d> points, std::span<const double> u)
    : first_{u.front()}, last_{u.back()} {
  std::vector<Eigen::Vector3d> slopes;
  for (std::size_t i = 1; i < points.size(); ++i) {
    slopes.push_back((points[i] - points[i - 1]) / (u[i] - u[i - 1]));
  }
  for (const BlendPiece& piece : blend_pieces(points, slopes, u)) {
    starts_.push_back(piece.start);
    pieces_.push_back(piece.cubic);
  }
}

Eigen::Vector3d BlendedPolyline::at(double u) const {
  u = std::clamp(u, first_, last_);
  const std::size_t i = piece_at(starts_, u);
  return pieces_[i].value(u - starts_[i]);
}

}  // namespace armature
