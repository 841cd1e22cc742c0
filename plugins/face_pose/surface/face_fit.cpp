// SPDX-License-Identifier: Apache-2.0
#include "face_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "armature/kinds/face_pose/face_pose.hpp"

namespace armature::face_pose::surface {
namespace {

constexpr int kCoarsest = 4;          // pixels averaged along rows and columns
constexpr int kStride = 2;            // every other pixel is compared until the last alignment
constexpr double kSearched = 24;      // [px] of disparity, nearer and farther than a start
constexpr double kSlackColumns = 30;  // [px] around the face in the right picture
constexpr double kSlackRows = 8;      // [px]
constexpr double kFewestPixels = 60;
// Share of the middle half of a feature that must be in the left picture and not over-exposed.
// Lips and eyes are darker than the skin around them, and are seen where it is over-exposed; what
// is white and covers them is not.
constexpr double kLeastSeen = 0.45;
// A surface is curved when its second-order terms stand out of their noise: chi-square of three,
// of which noise exceeds 20 once in 6000 pairs.
constexpr double kCurved = 20;

}  // namespace

void FaceFit::cut(double disparity, int step) {
  const PixelBox face = frame_.box(kFlatFace);
  const PixelBox with_edge{face.left - 3 * step, face.top - 3 * step, face.width + 6 * step,
                           face.height + 6 * step};
  in_left_.cut(left_, with_edge, step);
  in_right_.cut(right_,
                {with_edge.left - disparity - kSlackColumns, with_edge.top - kSlackRows,
                 with_edge.width + 2 * kSlackColumns, with_edge.height + 2 * kSlackRows},
                step);
}

/// Every `stride`th pixel of an area that the left picture shows, and the share of those.
double FaceFit::choose_pixels(const FaceArea& area, int stride) {
  pixels_.stride = stride;
  pixels_.at.clear();
  pixels_.value.clear();
  int all = 0;
  const PixelBox box = frame_.box(area);
  for (double v = std::floor(box.top); v < box.bottom(); v += stride) {
    for (double u = std::floor(box.left); u < box.right(); u += stride) {
      if (!frame_.is_in(area, u, v)) continue;
      ++all;
      const Eigen::Vector2f at{static_cast<float>(u), static_cast<float>(v)};
      if (!in_left_.covers(at.x(), at.y())) continue;
      const float value = in_left_.value(at.x(), at.y());
      if (is_saturated(value)) continue;
      pixels_.at.push_back(at);
      pixels_.value.push_back(value);
    }
  }
  return static_cast<double>(pixels_.at.size()) / std::max(all, 1);
}

/// 1 - the correlation of both pictures with that surface, or 2 when too little of it is seen.
double FaceFit::dissimilarity(const DisparitySurface& surface) const {
  double n = 0, l = 0, r = 0, ll = 0, rr = 0, lr = 0;
  for (std::size_t i = 0; i < pixels_.at.size(); ++i) {
    const Eigen::Vector2f at = pixels_.at[i];
    const auto u = static_cast<float>(at.x() - surface.at(at.cast<double>()));
    if (!in_right_.covers(u, at.y())) continue;
    const double left = pixels_.value[i], right = in_right_.value(u, at.y());
    n += 1;
    l += left;
    r += right;
    ll += left * left;
    rr += right * right;
    lr += left * right;
  }
  if (n < 0.5 * static_cast<double>(pixels_.at.size()) || n < kFewestPixels) return 2;
  const double scale = (ll - l * l / n) * (rr - r * r / n);
  return scale > 0 ? 1 - (lr - l * r / n) / std::sqrt(scale) : 2;
}

DisparitySurface FaceFit::best(const std::vector<DisparitySurface>& starts) const {
  DisparitySurface best = starts.front();
  double least = 3;
  for (const DisparitySurface& start : starts) {
    for (double more = -kSearched; more <= kSearched; more += kCoarsest) {
      DisparitySurface tried = start;
      tried.c[0] += more;
      const double found = dissimilarity(tried);
      if (found >= least) continue;
      least = found;
      best = tried;
    }
  }
  return best;
}

Expected<Alignment> FaceFit::align(const Features& face,
                                   const std::vector<DisparitySurface>& starts) {
  constexpr auto kNothing = "both pictures show nothing of a face that could be compared";
  constexpr Sought kPlaneAndRows{.terms = DisparitySurface::kPlane, .rows = true};
  frame_ = FaceFrame{face};
  Alignment found;
  for (int step = kCoarsest; step >= 1; step /= 2) {
    cut((step == kCoarsest ? starts.front() : found.surface).c[0], step);
    choose_pixels(kWholeFace, std::max(step, kStride));
    if (step == kCoarsest) found.surface = best(starts);
    if (!aligner_.align(pixels_, in_right_, kPlaneAndRows, 0, found)) {
      return refuse(FaceRefusal::uncertain, kNothing);
    }
  }
  Alignment curved = found;
  if (aligner_.align(pixels_, in_right_, {.terms = DisparitySurface::kQuadric, .rows = true}, 0,
                     curved)) {
    const Eigen::Vector3d bend = curved.surface.c.tail<3>();
    const Eigen::Matrix3d covariance = curved.covariance.bottomRightCorner<3, 3>();
    if (bend.dot(covariance.ldlt().solve(bend)) > kCurved) return curved;
  }
  // A plane says where its points are, and takes part with every pixel; of a curved face its
  // features say that themselves.
  choose_pixels(kFlatFace, 1);
  if (!aligner_.align(pixels_, in_right_, kPlaneAndRows, 0, found)) {
    return refuse(FaceRefusal::uncertain, kNothing);
  }
  return found;
}

bool FaceFit::align_feature(const FaceArea& feature, Alignment& alignment) {
  const FaceArea middle{feature.middle, 0.5 * feature.half_width, 0.5 * feature.half_height};
  if (choose_pixels(middle, 1) < kLeastSeen) return false;
  choose_pixels(feature, 1);
  return aligner_.align(pixels_, in_right_, {.terms = DisparitySurface::kPlane, .rows = false},
                        alignment.sigma, alignment);
}

}  // namespace armature::face_pose::surface
