// SPDX-License-Identifier: Apache-2.0
#include "alignment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace armature::face_pose::surface {
namespace {

constexpr int kIterations = 12;
constexpr double kConverged = 3e-3;           // [px] change of any disparity
constexpr Eigen::Index kFewest = 60;          // pixels
constexpr Eigen::Index kScattered = 2000;     // at least half of so many tell sigma to 3 %
constexpr float kBiweight = 6;                // sigmas: 98 % efficient with normal noise
constexpr float kSmallestSigma = 0.3f;        // grey values: what rounding to whole ones leaves
constexpr double kSmallestEigenvalue = 1e-9;  // of the equations, by the largest

/// Whether a difference of grey values is explained by noise, or by a disparity that is wrong by a
/// fraction of a pixel; `by_disparity`: [1/px] the derivative of the grey value.
bool agrees(float difference, float sigma, float by_disparity) {
  constexpr float kSigmas = 3.3f, kDisparity = 0.3f;
  const float expected = kDisparity * by_disparity;
  return difference * difference < kSigmas * kSigmas * (sigma * sigma + expected * expected);
}

}  // namespace

/// Fills one row of the equations for each pixel that both pictures show.
Eigen::Index Aligner::compare(const ComparedPixels& pixels, const GreyLevel& right,
                              const Sought& sought, const Alignment& alignment) {
  const Eigen::Vector2f middle = alignment.surface.middle.cast<float>();
  const auto per_reach = static_cast<float>(1 / alignment.surface.reach);
  const Eigen::Matrix<float, DisparitySurface::kQuadric, 1> c = alignment.surface.c.cast<float>();
  const Eigen::Vector3f rows = alignment.rows.cast<float>();
  const auto gain = static_cast<float>(alignment.gain);
  const auto offset = static_cast<float>(alignment.offset);
  Eigen::Index used = 0;
  for (std::size_t i = 0; i < pixels.at.size(); ++i) {
    const Eigen::Vector2f at = pixels.at[i];
    const float x = (at.x() - middle.x()) * per_reach, y = (at.y() - middle.y()) * per_reach;
    const float d = c[0] + c[1] * x + c[2] * y + c[3] * x * x + c[4] * x * y + c[5] * y * y;
    const float u = at.x() - d, v = at.y() + rows[0] + rows[1] * x + rows[2] * y;
    if (!right.covers(u, v)) continue;
    const GreyLevel::Sample s = right.sample(u, v);
    if (is_saturated(s.value)) continue;
    const float by_d = -gain * s.by_u, by_e = gain * s.by_v;
    float* row = &jacobian_(used, 0);
    const auto stride = jacobian_.outerStride();
    int k = 0;
    const auto put = [&](float value) { row[k++ * stride] = value; };
    put(by_d);
    put(by_d * x);
    put(by_d * y);
    if (sought.terms == DisparitySurface::kQuadric) {
      put(by_d * x * x);
      put(by_d * x * y);
      put(by_d * y * y);
    }
    put(s.value);
    put(1);
    if (sought.rows) {
      put(by_e);
      put(by_e * x);
      put(by_e * y);
    }
    difference_[used++] = pixels.value[i] - gain * s.value - offset;
  }
  return used;
}

/// The standard deviation of the first differences, by the median of as many as it needs.
float Aligner::scatter(Eigen::Index count) {
  const Eigen::Index every = 1 + count / kScattered;
  sorted_.clear();
  for (Eigen::Index i = 0; i < count; i += every) sorted_.push_back(std::abs(difference_[i]));
  const auto median = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
  std::nth_element(sorted_.begin(), median, sorted_.end());
  return std::max(kSmallestSigma, 1.4826f * *median);
}

bool Aligner::align(const ComparedPixels& pixels, const GreyLevel& right, const Sought& sought,
                    double noise, Alignment& alignment) {
  const int terms = sought.terms, unknowns = terms + (sought.rows ? 5 : 2);
  const auto most = static_cast<Eigen::Index>(pixels.at.size());
  if (jacobian_.rows() < most) {
    jacobian_.resize(most, kMost);
    weighted_.resize(most, kMost);
    difference_.resize(most);
    weight_.resize(most);
  }
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Eigen::Index used = compare(pixels, right, sought, alignment);
    if (used < kFewest) return false;
    const float sigma = scatter(used);
    const float judged = noise > 0 ? static_cast<float>(noise) : sigma;
    Eigen::Index agreeing = 0;
    for (Eigen::Index i = 0; i < used; ++i) {
      const float z = difference_[i] / (kBiweight * sigma);
      weight_[i] = std::abs(z) < 1 ? (1 - z * z) * (1 - z * z) : 0;
      if (agrees(difference_[i], judged, jacobian_(i, 0))) ++agreeing;
    }
    const auto by_unknowns = jacobian_.topLeftCorner(used, unknowns);
    auto weighted = weighted_.topLeftCorner(used, unknowns);
    weighted = weight_.head(used).asDiagonal() * by_unknowns;
    const Eigen::MatrixXd normal = (by_unknowns.transpose() * weighted).eval().cast<double>();
    const Eigen::VectorXd change_by =
        (weighted.transpose() * difference_.head(used)).eval().cast<double>();
    const Eigen::LDLT<Eigen::MatrixXd> solver{normal};
    const Eigen::VectorXd pivots = solver.vectorD();
    if (!(pivots.minCoeff() > kSmallestEigenvalue * pivots.maxCoeff())) return false;
    const Eigen::VectorXd change = solver.solve(change_by);
    if (!change.allFinite()) return false;
    alignment.surface.c.head(terms) += change.head(terms);
    alignment.gain += change[terms];
    alignment.offset += change[terms + 1];
    if (sought.rows) alignment.rows += change.tail<3>();
    alignment.sigma = sigma;
    alignment.agreeing = static_cast<double>(agreeing) / static_cast<double>(used);
    const bool converged = change.head(terms).cwiseAbs().maxCoeff() <= kConverged * right.step();
    if (!converged && iteration + 1 < kIterations) continue;
    alignment.covariance.setZero();
    alignment.covariance.topLeftCorner(terms, terms) =
        sigma * sigma * GreyLevel::shared_noise(1.0 * pixels.stride / right.step()) *
        solver.solve(Eigen::MatrixXd::Identity(unknowns, unknowns)).topLeftCorner(terms, terms);
    break;
  }
  return true;
}

}  // namespace armature::face_pose::surface
