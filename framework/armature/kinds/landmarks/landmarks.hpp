// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "armature/kinds/image_view.hpp"
#include "armature/kinds/made_for_robot.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// Which points of a face a finder tells, and in what order.
enum class LandmarkScheme {
  ibug68,   // the 68 points of iBUG 300-W, counted from 0
  five,     // left eye, right eye, tip of the nose, left and right corner of the mouth
  mesh468,  // the 468 points of MediaPipe's face mesh, counted from 0
};

/// A part of a face that several landmarks surround. "left" and "right" are sides of the image: the
/// image's left eye is the subject's right one.
enum class FaceFeature { left_eye, right_eye, mouth };

/// The number of landmarks of a scheme.
std::size_t landmark_count(LandmarkScheme scheme);
/// The landmarks whose mean is the centre of a feature.
std::span<const std::size_t> landmarks_around(FaceFeature feature, LandmarkScheme scheme);
/// "ibug68", "five", "mesh468".
std::string_view to_string(LandmarkScheme scheme);
/// Nothing for a name that no scheme has.
std::optional<LandmarkScheme> find_landmark_scheme(std::string_view name);

struct Landmark {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();  // [px]
  double sigma = 0;  // [px] standard deviation along a row and along a column
};

/// Finds the landmarks of one face in one image.
class LandmarkFinder {
 public:
  static constexpr std::string_view kKind = "landmarks";
  using Factory = MadeFromParams<LandmarkFinder>;

  virtual ~LandmarkFinder() = default;
  virtual LandmarkScheme scheme() const = 0;
  /// The landmarks of the face in `face`, a detector's box, as many as the scheme has; or why there
  /// are none. Whether there is a face at all is the detector's to say. Not const: a finder may
  /// keep scratch memory, never knowledge. May allocate.
  virtual Expected<std::vector<Landmark>> find(const ImageView& image, const PixelBox& face) = 0;
};

/// One face in one image.
struct FaceLandmarks {
  LandmarkScheme scheme = LandmarkScheme::ibug68;
  std::vector<Landmark> points;  // as many as the scheme has
  PixelBox box;
  double score = 0;           // of the detector
  double mean_intensity = 0;  // of the image inside the box, 0..255

  /// The centre of a feature: the mean of the landmarks around it. Its sigma is the largest of
  /// theirs, since neighbours err together.
  Landmark feature(FaceFeature which) const;
};

/// nullopt, or why no landmarks are sought in such a box: it can hold no face, or is not finite.
std::optional<std::string> invalid_input(const PixelBox& face);

/// nullopt, or why these are no landmarks: not as many as their scheme has, or one that is not
/// finite or has no sigma.
std::optional<std::string> invalid_input(const FaceLandmarks& face);

struct StereoLandmarks {
  FaceLandmarks left, right;
};

}  // namespace armature
