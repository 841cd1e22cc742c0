// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "armature/values/expected.hpp"
#include "lens.hpp"

namespace armature::stereo {

using Points = std::vector<Eigen::Vector2d>;

/// All that is looked for. Of one camera alone, the right one's numbers mean nothing.
struct Unknowns {
  std::array<Lens, 2> lenses;  // left, right
  Eigen::Isometry3d right_T_left = Eigen::Isometry3d::Identity();
  std::vector<Eigen::Isometry3d> left_T_board;  // of each view
};

/// The least squares over lenses, posture and poses of boards: what is left between the pixels that
/// corners should have and those that they have.
class BundleProblem {
 public:
  static constexpr int kOfLens = 9;  // fx, fy, cx, cy, k1, k2, p1, p2, k3
  static constexpr int kOfPose = 6;  // a rotation vector and a translation
  /// Where the unknowns stand in a vector: both lenses, the right camera's posture, each view's
  /// pose.
  static constexpr int kPosture = 2 * kOfLens, kViews = kPosture + kOfPose;

  /// `board`: the corners [m]. A view has the pixels of the left and of the right camera, in the
  /// order of the board's corners; null: that camera is not part of the problem. All are kept by
  /// reference.
  BundleProblem(const Points& board, std::vector<std::array<const Points*, 2>> views, bool with_k3);

  int size() const { return kViews + kOfPose * static_cast<int>(views_.size()); }
  int measurements() const;
  int free_unknowns() const;

  /// u and v of each corner of a view, projected less seen [px].
  Eigen::VectorXd residuals(const Unknowns& x, std::size_t view, std::size_t camera) const;
  /// Of all residuals, summed.
  double squares(const Unknowns& x) const;
  /// J^T J and J^T r, by central differences; what is not looked for has 1 on the diagonal.
  void linearize(const Unknowns& x, Eigen::MatrixXd& h, Eigen::VectorXd& g) const;
  Unknowns changed_by(const Unknowns& x, const Eigen::VectorXd& by) const;

 private:
  bool is_free(int column) const;
  std::vector<int> columns_of(std::size_t view, std::size_t camera) const;

  const Points& board_;
  std::vector<std::array<const Points*, 2>> views_;
  bool with_k3_;
  std::array<bool, 2> uses_{};  // which cameras
};

/// `pose`, moved by a rotation vector and a translation, both on its left.
Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Eigen::Ref<const Eigen::VectorXd>& by);

/// The unknowns of the least squares, from `x` on, by Levenberg-Marquardt; or that they do not
/// converge.
Expected<Unknowns> solved(const BundleProblem& problem, Unknowns x);

}  // namespace armature::stereo
