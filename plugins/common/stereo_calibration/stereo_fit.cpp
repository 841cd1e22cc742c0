// SPDX-License-Identifier: Apache-2.0
#include "stereo_fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "board_pose.hpp"
#include "bundle_problem.hpp"

namespace armature::stereo {
namespace {

using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr std::size_t kMinViews = 3;
constexpr double kMaxFocalError = 0.05;

struct OneCamera {
  Lens lens;
  std::vector<Isometry3d> camera_T_board;
  double squares = 0;  // of what is left [px^2]
};

/// From several focal lengths, of which the best solution counts: what a bent lens does to a board
/// may be more than what perspective does, which the homographies' own focal length goes by.
Expected<OneCamera> fit_one(const Points& board, const std::vector<const Points*>& views,
                            const FitOptions& options) {
  constexpr std::array<double, 5> kOfTheWidth{0.4, 0.6, 0.9, 1.4, 2.5};
  const Vector2d centre{0.5 * (options.width - 1), 0.5 * (options.height - 1)};
  std::vector<Eigen::Matrix3d> homographies;
  std::vector<std::array<const Points*, 2>> seen;
  for (const Points* view : views) {
    homographies.push_back(homography(board, *view));
    seen.push_back({view, nullptr});
  }
  std::vector<double> focal_lengths;
  if (const auto f = focal_length(homographies, centre)) focal_lengths.push_back(*f);
  for (const double part : kOfTheWidth) focal_lengths.push_back(part * options.width);
  const BundleProblem problem{board, seen, options.with_k3};
  std::optional<Unknowns> best;
  std::string why;
  for (const double f : focal_lengths) {
    Unknowns begin;
    begin.lenses[0] = {.fx = f, .fy = f, .cx = centre.x(), .cy = centre.y()};
    for (const auto& h : homographies) begin.left_T_board.push_back(pose_of_board(h, f, centre));
    auto found = solved(problem, begin);
    if (!found) {
      why = found.error().text;
    } else if (!best || problem.squares(*found) < problem.squares(*best)) {
      best = std::move(*found);
    }
  }
  if (!best) return refuse(why);
  const double squares = problem.squares(*best);
  return OneCamera{best->lenses[0], std::move(best->left_T_board), squares};
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// The right camera's posture in the middle of what single views say: some wrong ones do not move
/// it.
Isometry3d middle_posture(const OneCamera& left, const OneCamera& right) {
  Isometry3d middle = right.camera_T_board[0] * left.camera_T_board[0].inverse();
  for (int round = 0; round < 5; ++round) {
    std::array<std::vector<double>, BundleProblem::kOfPose> off;
    for (std::size_t v = 0; v < left.camera_T_board.size(); ++v) {
      const Isometry3d one = right.camera_T_board[v] * left.camera_T_board[v].inverse();
      const Eigen::AngleAxisd turn{Eigen::Matrix3d{one.linear() * middle.linear().transpose()}};
      for (int i = 0; i < 3; ++i) {
        off[i].push_back(turn.angle() * turn.axis()[i]);
        off[3 + i].push_back(one.translation()[i] - middle.translation()[i]);
      }
    }
    VectorXd by(BundleProblem::kOfPose);
    std::ranges::transform(off, by.begin(), median_of);
    middle = moved(middle, by);
  }
  return middle;
}

/// The distance of a board's corners in the right picture from where the left picture and
/// `right_T_left` have them: rms of each view [px].
std::vector<double> apart_px(const Points& board, const OneCamera& left, const OneCamera& right,
                             const Isometry3d& right_T_left) {
  std::vector<double> apart;
  for (std::size_t v = 0; v < left.camera_T_board.size(); ++v) {
    double squares = 0;
    for (const Vector2d& corner : board) {
      const Vector3d point{corner.x(), corner.y(), 0};
      const Vector3d by_left = right_T_left * left.camera_T_board[v] * point;
      const Vector3d by_right = right.camera_T_board[v] * point;
      squares += right.lens.fx * right.lens.fx *
                 (by_left.normalized() - by_right.normalized()).squaredNorm();
    }
    apart.push_back(std::sqrt(squares / static_cast<double>(board.size())));
  }
  return apart;
}

/// Which views are of another rig, or of no rig at all; or "".
std::string contradiction(const std::vector<BoardView>& views, const std::vector<double>& apart,
                          int width) {
  // A camera that was knocked is less off, and a wrong picture more.
  constexpr double kFarApart = 0.03;  // of the width
  std::vector<std::string> names;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (!(apart[v] <= kFarApart * width)) names.push_back(views[v].name);
  }
  if (names.empty()) return "";
  const double farthest = *std::ranges::max_element(apart);
  if (2 * names.size() >= views.size()) {
    return fmt::format(
        "the pairs contradict each other on where the right camera is, by up to {:.0f} px in {} of "
        "{} pairs: are the two pictures of a pair of one moment, both folders numbered alike, and "
        "was no camera moved?",
        farthest, names.size(), views.size());
  }
  return fmt::format(
      "where the other pairs have the right camera, the boards of {} are up to {:.0f} px from "
      "where they are seen: are left and right exchanged, of different moments, or was a "
      "camera moved? leave {} out",
      fmt::join(names, ", "), farthest, names.size() == 1 ? "it" : "them");
}

FitErrors errors_of(const BundleProblem& problem, const Unknowns& x) {
  MatrixXd h;
  VectorXd g;
  problem.linearize(x, h, g);
  const double freedom = problem.measurements() - problem.free_unknowns();
  const MatrixXd covariance =
      h.ldlt().solve(MatrixXd::Identity(h.rows(), h.cols())) * (problem.squares(x) / freedom);
  const auto sigma = [&](int column) { return std::sqrt(covariance(column, column)); };
  FitErrors errors;
  for (const int c : {0, BundleProblem::kOfLens}) {
    errors.focal_px = std::max({errors.focal_px, sigma(c), sigma(c + 1)});
    errors.centre_px = std::max({errors.centre_px, sigma(c + 2), sigma(c + 3)});
  }
  for (int i = 0; i < 3; ++i)
    errors.rotation = std::max(errors.rotation, sigma(BundleProblem::kPosture + i));
  const Vector3d along = x.right_T_left.translation().normalized();
  errors.baseline_m = std::sqrt(along.dot(
      covariance.block<3, 3>(BundleProblem::kPosture + 3, BundleProblem::kPosture + 3) * along));
  return errors;
}

}  // namespace

Expected<StereoFit> fit_stereo(const Points& board, const std::vector<BoardView>& views,
                               const FitOptions& options) {
  if (views.size() < kMinViews) {
    return refuse(fmt::format(
        "{} pairs show the board to both cameras; {} are the least, 15 or more are good",
        views.size(), kMinViews));
  }
  std::vector<const Points*> lefts, rights;
  std::vector<std::array<const Points*, 2>> both;
  for (const BoardView& view : views) {
    lefts.push_back(&view.left);
    rights.push_back(&view.right);
    both.push_back({&view.left, &view.right});
  }
  const auto left = fit_one(board, lefts, options);
  if (!left) return refuse("left: " + left.error().text);
  const auto right = fit_one(board, rights, options);
  if (!right) return refuse("right: " + right.error().text);
  const Isometry3d posture = middle_posture(*left, *right);
  if (std::string why =
          contradiction(views, apart_px(board, *left, *right, posture), options.width);
      !why.empty()) {
    return refuse(std::move(why));
  }
  const BundleProblem problem{board, both, options.with_k3};
  const auto found = solved(problem, {.lenses = {left->lens, right->lens},
                                      .right_T_left = posture,
                                      .left_T_board = left->camera_T_board});
  if (!found) return tl::unexpected{found.error()};

  const FitErrors errors = errors_of(problem, *found);
  const double f = found->lenses[0].fx;
  if (!(errors.focal_px <= kMaxFocalError * std::abs(f))) {
    return refuse(fmt::format(
        "the focal length is known to {:.2g} px of {:.4g} only: the boards are too parallel to "
        "the pictures; tilt the board by 20 to 40 degrees to all sides",
        errors.focal_px, f));
  }

  StereoFit fit{.calibration = {.width = options.width,
                                .height = options.height,
                                .left = found->lenses[0],
                                .right = found->lenses[1],
                                .right_T_left = found->right_T_left},
                .left_T_board = found->left_T_board,
                .errors = errors};
  double left_squares = 0, right_squares = 0;
  const auto points = static_cast<double>(board.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    const double a = problem.residuals(*found, v, 0).squaredNorm();
    const double b = problem.residuals(*found, v, 1).squaredNorm();
    left_squares += a;
    right_squares += b;
    fit.view_rms_px.push_back(std::sqrt((a + b) / (2 * points)));
  }
  const double all = points * static_cast<double>(views.size());
  fit.left_rms_px = std::sqrt(left_squares / all);
  fit.right_rms_px = std::sqrt(right_squares / all);
  fit.alone_rms_px = std::sqrt((left->squares + right->squares) / (2 * all));
  return fit;
}

}  // namespace armature::stereo
