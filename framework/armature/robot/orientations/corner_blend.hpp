// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace armature ARMATURE_EXPORT {

// Straight lines in space whose corners are cubic B-splines (Zhong et al. 2023, equations (11) to
// (15)): continuous up to the second derivative, and through every corner. The space is that of
// positions, or that of rotation vectors.

/// c0 + c1 x + c2 x^2 + c3 x^3, one column each.
struct VectorCubic {
  Eigen::Matrix<double, 3, 4> c = Eigen::Matrix<double, 3, 4>::Zero();

  Eigen::Vector3d value(double x) const {
    return c.col(0) + x * (c.col(1) + x * (c.col(2) + x * c.col(3)));
  }
  Eigen::Vector3d first(double x) const { return c.col(1) + x * (2 * c.col(2) + 3 * x * c.col(3)); }
  Eigen::Vector3d second(double x) const { return 2 * c.col(2) + 6 * x * c.col(3); }
};

/// Control points of a cubic B-spline with the knots 0, 0, 0, 0, 1/4, 1/2, 3/4, 1, 1, 1, 1.
using CornerControls = std::array<Eigen::Vector3d, 7>;

/// The spline from D to E that is at B when its parameter is 1/2, has the derivatives `at_D` and
/// `at_E` at its ends and no second derivative there. Equations (14) and (15), solved.
CornerControls corner_controls(const Eigen::Vector3d& D, const Eigen::Vector3d& B,
                               const Eigen::Vector3d& E, const Eigen::Vector3d& at_D,
                               const Eigen::Vector3d& at_E);

/// The same spline in `duration`: four cubics, each counting from its start.
std::array<VectorCubic, 4> cubics_of(const CornerControls& d, double duration);

/// A piece of a blended path; it counts from `start`. `key`: the corner that it begins or bends at.
struct BlendPiece {
  double start = 0;
  std::size_t key = 0;
  VectorCubic cubic;
};

/// A line from `from` with the constant velocity `slope`, and the four cubics of a corner.
void append_line(std::vector<BlendPiece>& pieces, double start, std::size_t key,
                 const Eigen::Vector3d& from, const Eigen::Vector3d& slope);
void append_corner(std::vector<BlendPiece>& pieces, double start, std::size_t key,
                   const CornerControls& controls, double duration);

/// From key to key with the constant velocity slopes[i], the change blended about each inner key:
/// half-way to the nearer neighbour (in u) on either side. The end derivatives of a blend are the
/// velocities times its duration, so that pieces of any length fit. `points`: where the keys are,
/// of each in the space in which its own pieces are told; one more than slopes; `u` ascends.
std::vector<BlendPiece> blend_pieces(std::span<const Eigen::Vector3d> points,
                                     std::span<const Eigen::Vector3d> slopes,
                                     std::span<const double> u);

/// Which of the ascending `starts` holds at `u`; the first before it, the last behind it.
std::size_t piece_at(std::span<const double> starts, double u);

/// Straight lines through points, blended.
class BlendedPolyline {
 public:
  /// Two points or more, with their ascending parameters.
  BlendedPolyline(std::span<const Eigen::Vector3d> points, std::span<const double> u);

  /// Real-time safe: no allocation, O(log pieces). The ends are held beyond them.
  Eigen::Vector3d at(double u) const;

 private:
  double first_, last_;
  std::vector<double> starts_;
  std::vector<VectorCubic> pieces_;
};

}  // namespace armature
