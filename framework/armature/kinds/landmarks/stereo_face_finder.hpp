// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "armature/kinds/detector/detector.hpp"
#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// Finds the landmarks of one face in the pictures of a rectified stereo pair, one pair after the
/// other.
///
/// The face is sought near where it was last, then everywhere; in the right picture in the rows of
/// the left one first. Of several faces it keeps to the one that it has: the nearest to the last
/// one, and the largest where there was none. The detector's score chooses nothing: it changes from
/// picture to picture.
class StereoFaceFinder {
 public:
  /// Where the face was last, which the caller owns; value-initialised: it is sought everywhere.
  struct State {
    std::optional<PixelBox> left, right;
  };

  /// Pictures whose brightest part (99.5 %) is darker than `stretch_below` are stretched to the
  /// whole range of grey values before they are searched. The plugins outlive this.
  StereoFaceFinder(FaceDetector& detector, LandmarkFinder& landmarks, double stretch_below)
      : detector_{detector}, landmarks_{landmarks}, stretch_below_{stretch_below} {}

  /// The landmarks in both pictures, or why not ("no face in the left image"). A face that is not
  /// found is forgotten. Allocates.
  Expected<StereoLandmarks> find(const ImageView& left, const ImageView& right, State& state);

 private:
  using Faces = Expected<std::optional<DetectedFace>>;
  Faces find_left(const ImageView& left, const std::optional<PixelBox>& last);
  Faces find_right(const ImageView& right, const std::optional<PixelBox>& last,
                   const PixelBox& in_left);
  Faces detect(const ImageView& image, const SearchRegion& region,
               const std::optional<PixelBox>& near);
  Expected<FaceLandmarks> landmarks(const ImageView& original, const ImageView& stretched,
                                    const DetectedFace& face);

  FaceDetector& detector_;
  LandmarkFinder& landmarks_;
  double stretch_below_;
  std::vector<std::uint8_t> left_pixels_, right_pixels_;  // of stretched pictures
};

}  // namespace armature
