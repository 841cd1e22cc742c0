// SPDX-License-Identifier: Apache-2.0
#include "frontal_looks.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "armature/kinds/face_pose/face_pose.hpp"
#include "face_frame.hpp"

namespace armature::face_pose::surface {
namespace {

using Look = std::array<Landmark, 3>;

Expected<Look> look(const ImageView& view, const PixelBox& box, LandmarkFinder& finder) {
  const auto found = finder.find(view, box);
  if (!found) return refuse(FaceRefusal::covered, "frontal view: " + found.error().text);
  const FaceLandmarks face{.scheme = finder.scheme(), .points = *found, .box = {}};
  if (auto wrong = invalid_input(face))
    return refuse(FaceRefusal::covered, "frontal view: " + *wrong);
  Look seen;
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = face.feature(kFaceFeatures[i].which);
  return seen;
}

/// The look at a feature that is farthest from the others.
std::size_t outlier(std::span<const Look> looks, std::size_t feature) {
  const auto distance = [&](const Look& from) {
    double sum = 0;
    for (const Look& to : looks) sum += (from[feature].point - to[feature].point).norm();
    return sum;
  };
  return static_cast<std::size_t>(std::ranges::max_element(looks, {}, distance) - looks.begin());
}

/// A feature by all looks but `left_out`.
SeenFeature seen_in(std::span<const Look> looks, std::size_t feature, std::size_t left_out,
                    double eye_distance) {
  SeenFeature seen{.at = Eigen::Vector2d::Zero(), .sigma = looks[0][feature].sigma, .moved = 0};
  int count = 0;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    if (i == left_out) continue;
    const Eigen::Vector2d& one = looks[i][feature].point;
    seen.at += one;
    ++count;
    for (std::size_t j = 0; j < i; ++j) {
      if (j == left_out) continue;
      seen.moved = std::max(seen.moved, (one - looks[j][feature].point).norm() / eye_distance);
    }
  }
  seen.at /= count;
  return seen;
}

/// Whether no feature moves too far between looks; of more than two each loses its outlier.
bool are_steady(std::span<const Look> looks, double eye_distance, double max_unsteadiness,
                std::array<SeenFeature, 3>& seen) {
  bool result = true;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    seen[i] = seen_in(looks, i, looks.size() > 2 ? outlier(looks, i) : looks.size(), eye_distance);
    result = result && seen[i].moved <= max_unsteadiness;
  }
  return result;
}

}  // namespace

Expected<std::array<SeenFeature, 3>> look_at_features(FrontalView& view, LandmarkFinder& finder,
                                                      double max_unsteadiness,
                                                      bool tries_lower_boxes) {
  const ImageView image = view.image();
  std::array<SeenFeature, 3> seen;
  for (const auto& corners : view.face_boxes()) {
    std::vector<Look> looks;
    for (const std::size_t count : {corners.size() / 2, corners.size()}) {
      while (looks.size() < count) {
        const auto next = look(image, corners[looks.size()], finder);
        if (!next) return tl::unexpected{next.error()};
        looks.push_back(*next);
      }
      if (are_steady(looks, view.eye_distance(), max_unsteadiness, seen)) return seen;
    }
    if (!tries_lower_boxes) break;
  }
  return seen;
}

}  // namespace armature::face_pose::surface
