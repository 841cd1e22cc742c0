// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "disparity_surface.hpp"
#include "grey_level.hpp"

namespace armature::face_pose::surface {

/// What makes the right picture equal to the left one: left(u, v) = gain right(u - d, v + e) +
/// offset, where d is the surface's disparity, and e is 0 in a pair that is rectified.
struct Alignment {
  DisparitySurface surface;
  double gain = 1;
  double offset = 0;
  Eigen::Vector3d rows = Eigen::Vector3d::Zero();  // [px] e = rows . (1, x, y) of the surface

  double sigma = 0;     // standard deviation of the grey values where both pictures agree
  double agreeing = 0;  // share of the compared pixels where they do
  DisparitySurface::Covariance covariance = DisparitySurface::Covariance::Zero();  // of its terms
};

/// What is sought: how many terms of the surface, gain and offset always, the rows or not.
struct Sought {
  int terms;  // DisparitySurface::kPlane or kQuadric
  bool rows;
};

/// Whether a pixel tells nothing because it is over-exposed, or next to one that is.
inline bool is_saturated(float grey) { return grey >= 250; }

/// Pixels of the left picture to compare: of each `stride` columns and rows one.
struct ComparedPixels {
  int stride = 1;                   // [px]
  std::vector<Eigen::Vector2f> at;  // [px]
  std::vector<float> value;
};

/// Aligns a surface by Gauss-Newton on the grey values themselves; what does not fit (Tukey's
/// biweight) has no part (Baker and Matthews 2004, "Lucas-Kanade 20 years on", forward additive).
/// Keeps its memory.
class Aligner {
 public:
  /// Improves `alignment`; what is not sought stays. False when too few pixels can be compared or
  /// nothing in them tells where they belong. `noise`: [grey values] by which agreement is judged;
  /// 0: by what the differences themselves scatter.
  bool align(const ComparedPixels& pixels, const GreyLevel& right, const Sought& sought,
             double noise, Alignment& alignment);

 private:
  static constexpr int kMost = DisparitySurface::kQuadric + 5;

  Eigen::Index compare(const ComparedPixels& pixels, const GreyLevel& right, const Sought& sought,
                       const Alignment& alignment);
  float scatter(Eigen::Index count);

  Eigen::Matrix<float, Eigen::Dynamic, kMost> jacobian_, weighted_;
  Eigen::VectorXf difference_, weight_;
  std::vector<float> sorted_;
};

}  // namespace armature::face_pose::surface
