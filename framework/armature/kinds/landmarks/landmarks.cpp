// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/landmarks/landmarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace armature {
namespace {

struct Scheme {
  std::string_view name;
  std::size_t count;
  std::vector<std::size_t> left_eye, right_eye, mouth;
};

const Scheme& scheme_of(LandmarkScheme scheme) {
  // A mouth opens to both sides of the mean of its inner points.
  static const std::array<Scheme, 3> schemes{
      Scheme{"ibug68", 68, {36, 37, 38, 39, 40, 41}, {42, 43, 44, 45, 46, 47}, {60, 62, 64, 66}},
      Scheme{"five", 5, {0}, {1}, {3, 4}},
      // Corners and lids of the eyes, as in ibug68, and all of the inner lips.
      Scheme{"mesh468",
             468,
             {33, 160, 158, 133, 153, 144},
             {362, 385, 387, 263, 373, 380},
             {78,  191, 80,  81,  82,  13, 312, 311, 310, 415,
              308, 324, 318, 402, 317, 14, 87,  178, 88,  95}},
  };
  return schemes[static_cast<std::size_t>(scheme)];
}

}  // namespace

std::size_t landmark_count(LandmarkScheme scheme) { return scheme_of(scheme).count; }

std::span<const std::size_t> landmarks_around(FaceFeature feature, LandmarkScheme scheme) {
  const Scheme& s = scheme_of(scheme);
  if (feature == FaceFeature::left_eye) return s.left_eye;
  return feature == FaceFeature::right_eye ? s.right_eye : s.mouth;
}

std::string_view to_string(LandmarkScheme scheme) { return scheme_of(scheme).name; }

std::optional<LandmarkScheme> find_landmark_scheme(std::string_view name) {
  for (const LandmarkScheme scheme :
       {LandmarkScheme::ibug68, LandmarkScheme::five, LandmarkScheme::mesh468}) {
    if (to_string(scheme) == name) return scheme;
  }
  return std::nullopt;
}

Landmark FaceLandmarks::feature(FaceFeature which) const {
  const auto around = landmarks_around(which, scheme);
  Landmark centre;
  for (const std::size_t i : around) {
    centre.point += points[i].point;
    centre.sigma = std::max(centre.sigma, points[i].sigma);
  }
  centre.point /= static_cast<double>(around.size());
  return centre;
}

std::optional<std::string> invalid_input(const PixelBox& face) {
  constexpr double kMinFace = 1, kMaxFace = 1e5;  // [px]
  // Written so that what is not finite is refused, too.
  const auto is_size = [](double size) { return size >= kMinFace && size <= kMaxFace; };
  if (!is_size(face.width) || !is_size(face.height)) return "the face's box has no size";
  const double shape = face.height / face.width;
  if (shape < 0.1 || shape > 10) return "the face's box is ten times as long as wide";
  const auto is_near = [](double at) { return std::abs(at) <= kMaxFace; };
  if (!is_near(face.left) || !is_near(face.top)) return "the face's box is not in the image";
  return std::nullopt;
}

std::optional<std::string> invalid_input(const FaceLandmarks& face) {
  const std::size_t count = landmark_count(face.scheme);
  if (face.points.size() != count) {
    return fmt::format("{} landmarks, and {} has {}", face.points.size(), to_string(face.scheme),
                       count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Landmark& landmark = face.points[i];
    if (!landmark.point.allFinite()) return fmt::format("landmark {} is not finite", i);
    if (!(landmark.sigma > 0 && std::isfinite(landmark.sigma))) {
      return fmt::format("landmark {} has a sigma of {} px, not a positive one", i, landmark.sigma);
    }
  }
  return std::nullopt;
}

}  // namespace armature
