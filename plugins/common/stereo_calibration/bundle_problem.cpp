// SPDX-License-Identifier: Apache-2.0
#include "bundle_problem.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

namespace armature::stereo {
namespace {

using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

Lens changed(const Lens& lens, const Eigen::Ref<const VectorXd>& by) {
  Lens result = lens;
  for (const auto& [number, i] :
       {std::pair{&result.fx, 0}, {&result.fy, 1}, {&result.cx, 2}, {&result.cy, 3}}) {
    *number += by[i];
  }
  for (int i = 0; i < 5; ++i) result.distortion[static_cast<std::size_t>(i)] += by[4 + i];
  return result;
}

}  // namespace

Isometry3d moved(const Isometry3d& pose, const Eigen::Ref<const VectorXd>& by) {
  const Vector3d turn = by.head<3>();
  Isometry3d motion = Isometry3d::Identity();
  if (turn.norm() > 0) {
    motion.linear() = Eigen::AngleAxisd{turn.norm(), turn.normalized()}.toRotationMatrix();
  }
  Isometry3d result = pose;
  result.linear() = motion.linear() * pose.linear();
  result.translation() = pose.translation() + by.segment<3>(3);
  return result;
}

BundleProblem::BundleProblem(const Points& board, std::vector<std::array<const Points*, 2>> views,
                             bool with_k3)
    : board_{board}, views_{std::move(views)}, with_k3_{with_k3} {
  for (const auto& view : views_) {
    for (const std::size_t camera : {0U, 1U}) uses_[camera] = uses_[camera] || view[camera];
  }
}

int BundleProblem::measurements() const {
  std::size_t points = 0;
  for (const auto& view : views_) {
    for (const Points* seen : view) points += seen ? seen->size() : 0;
  }
  return 2 * static_cast<int>(points);
}

bool BundleProblem::is_free(int column) const {
  if (column >= kViews) return true;
  if (column >= kPosture) return uses_[0] && uses_[1];
  const bool is_k3 = column % kOfLens == kOfLens - 1;
  return uses_[static_cast<std::size_t>(column / kOfLens)] && (with_k3_ || !is_k3);
}

int BundleProblem::free_unknowns() const {
  int count = 0;
  for (int column = 0; column < size(); ++column) count += is_free(column);
  return count;
}

VectorXd BundleProblem::residuals(const Unknowns& x, std::size_t view, std::size_t camera) const {
  const Isometry3d camera_T_board =
      camera == 0 ? x.left_T_board[view] : x.right_T_left * x.left_T_board[view];
  const Points& seen = *views_[view][camera];
  VectorXd all(2 * static_cast<Eigen::Index>(seen.size()));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Vector3d point = camera_T_board * Vector3d{board_[i].x(), board_[i].y(), 0};
    all.segment<2>(2 * static_cast<Eigen::Index>(i)) =
        x.lenses[camera].project(point.hnormalized()) - seen[i];
  }
  return all;
}

double BundleProblem::squares(const Unknowns& x) const {
  double sum = 0;
  for (std::size_t v = 0; v < views_.size(); ++v) {
    for (const std::size_t c : {0U, 1U}) {
      if (views_[v][c]) sum += residuals(x, v, c).squaredNorm();
    }
  }
  return sum;
}

/// The unknowns that the residuals of one camera in one view depend on.
std::vector<int> BundleProblem::columns_of(std::size_t view, std::size_t camera) const {
  std::vector<int> columns;
  const auto add = [&](int first, int count) {
    for (int i = 0; i < count; ++i) columns.push_back(first + i);
  };
  add(static_cast<int>(camera) * kOfLens, kOfLens);
  if (camera == 1) add(kPosture, kOfPose);
  add(kViews + static_cast<int>(view) * kOfPose, kOfPose);
  return columns;
}

void BundleProblem::linearize(const Unknowns& x, MatrixXd& h, VectorXd& g) const {
  h.setZero(size(), size());
  g.setZero(size());
  for (std::size_t v = 0; v < views_.size(); ++v) {
    for (const std::size_t c : {0U, 1U}) {
      if (!views_[v][c]) continue;
      const std::vector<int> columns = columns_of(v, c);
      const VectorXd r = residuals(x, v, c);
      MatrixXd j(r.size(), static_cast<Eigen::Index>(columns.size()));
      for (std::size_t k = 0; k < columns.size(); ++k) {
        // Pixels change by thousandths, distortion and poses (radians, metres) by millionths.
        const bool in_pixels = columns[k] < kPosture && columns[k] % kOfLens < 4;
        const double step = in_pixels ? 1e-3 : 1e-6;
        VectorXd by = VectorXd::Zero(size());
        by[columns[k]] = step;
        const Unknowns more = changed_by(x, by), less = changed_by(x, -by);
        j.col(static_cast<Eigen::Index>(k)) =
            (residuals(more, v, c) - residuals(less, v, c)) / (2 * step);
      }
      const MatrixXd square = j.transpose() * j;
      const VectorXd product = j.transpose() * r;
      for (std::size_t a = 0; a < columns.size(); ++a) {
        g[columns[a]] += product[static_cast<Eigen::Index>(a)];
        for (std::size_t b = 0; b < columns.size(); ++b) {
          h(columns[a], columns[b]) +=
              square(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
        }
      }
    }
  }
  for (int i = 0; i < size(); ++i) {
    if (is_free(i)) continue;
    h.row(i).setZero();
    h.col(i).setZero();
    h(i, i) = 1;
    g[i] = 0;
  }
}

Unknowns BundleProblem::changed_by(const Unknowns& x, const VectorXd& by) const {
  Unknowns result = x;
  for (const int c : {0, 1}) {
    auto& lens = result.lenses[static_cast<std::size_t>(c)];
    lens = changed(lens, by.segment(c * kOfLens, kOfLens));
  }
  result.right_T_left = moved(x.right_T_left, by.segment(kPosture, kOfPose));
  for (std::size_t v = 0; v < views_.size(); ++v) {
    result.left_T_board[v] =
        moved(x.left_T_board[v], by.segment(kViews + static_cast<int>(v) * kOfPose, kOfPose));
  }
  return result;
}

/// Levenberg-Marquardt with the damping scaled by the diagonal.
Expected<Unknowns> solved(const BundleProblem& problem, Unknowns x) {
  constexpr int kMaxSteps = 100;
  constexpr double kStill = 1e-10, kMaxDamping = 1e12;
  double damping = 1e-3, squares = problem.squares(x);
  MatrixXd h;
  VectorXd g;
  for (int i = 0; i < kMaxSteps; ++i) {
    problem.linearize(x, h, g);
    bool better = false;
    for (; !better && damping < kMaxDamping; damping *= better ? 0.1 : 10) {
      MatrixXd damped = h;
      damped.diagonal() *= 1 + damping;
      const VectorXd by = damped.ldlt().solve(-g);
      const Unknowns next = problem.changed_by(x, by);
      const double next_squares = problem.squares(next);
      if (!std::isfinite(next_squares) || next_squares > squares) continue;
      const bool still = squares - next_squares <= kStill * squares;
      x = next;
      squares = next_squares;
      if (still) return x;
      better = true;
    }
    if (!better) return x;
  }
  return refuse(
      fmt::format("the calibration does not converge within {} steps; tilt the board by 20 to 40 "
                  "degrees to all sides, and look "
                  "whether the corners are those of one board",
                  kMaxSteps));
}

}  // namespace armature::stereo
