// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "armature/kinds/detector/detector.hpp"
#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// All of an image.
PixelBox whole(const ImageView& image);
/// Mean grey value of the image inside `box`.
double mean_intensity(const ImageView& image, const PixelBox& box);

/// Finds the landmarks of one face in the pictures of a rectified stereo pair, one pair after the
/// other.
///
/// The face is sought near where it was last, then everywhere; in the right picture in the rows of
/// the left one first. With `detect_every` above 1 it is sought in every so many pairs only; in
/// between its landmarks are sought where those of the last pair say that the face is.
///
/// Of several faces in the left picture it keeps to the one that it has: the nearest to the last
/// one, also where one pair misses that, and the largest where there was none. In the right picture
/// it takes the same face: not further right than in the left one; near the last one, where that
/// has about the same rows and size; else the one whose rows and size are most alike, and of those
/// that are as alike as a detector tells the one whose landmarks lie in the same rows. The
/// detector's score chooses nothing: it changes from picture to picture.
class StereoFaceFinder {
 public:
  /// Where the face was last, which the caller owns; value-initialised: it is sought everywhere.
  struct State {
    struct Face {
      DetectedFace where;
      Eigen::Vector2d middle = Eigen::Vector2d::Zero();  // [px] of its landmarks
      double spread = 0;  // [px] of them about their middle; 0: none were found yet
    };
    std::optional<Face> left, right;
    int pairs_since = 0;  // it was detected
  };
  struct Options {
    /// Pictures whose brightest part (99.5 %) is darker are stretched to the whole range of grey
    /// values before they are searched.
    double stretch_below;
    int detect_every = 1;  // pairs
  };

  /// The plugins outlive this.
  StereoFaceFinder(FaceDetector& detector, LandmarkFinder& landmarks, const Options& options)
      : detector_{detector}, landmarks_{landmarks}, options_{options} {}

  /// The landmarks in both pictures, or why not ("no face in the left image"). A face that is
  /// further right in the right picture is none of this pair: the reason asks whether the cameras
  /// are exchanged. A face that two pairs have missed is forgotten. Allocates.
  Expected<StereoLandmarks> find(const ImageView& left, const ImageView& right, State& state);

 private:
  using Faces = Expected<std::optional<DetectedFace>>;
  std::optional<Reason> detect_both(const ImageView& left, const ImageView& right, State& state);
  Faces find_left(const ImageView& left, const std::optional<PixelBox>& last);
  Faces find_right(const ImageView& right, const std::optional<PixelBox>& last,
                   const ImageView& left, const PixelBox& in_left);
  std::pair<DetectedFace, double> most_alike(const ImageView& right,
                                             const std::vector<DetectedFace>& faces,
                                             const ImageView& left, const PixelBox& in_left);
  Faces find_on_wrong_side(const ImageView& right, const PixelBox& in_left);
  using Cost = std::function<double(const PixelBox& face)>;
  Faces detect(const ImageView& image, const SearchRegion& region, const Cost& cost);
  Expected<std::vector<DetectedFace>> detect_all(const ImageView& image, const SearchRegion& region,
                                                 const Cost& cost);
  Expected<FaceLandmarks> landmarks(const ImageView& original, const ImageView& stretched,
                                    State::Face& face);

  FaceDetector& detector_;
  LandmarkFinder& landmarks_;
  Options options_;
  std::vector<std::uint8_t> left_pixels_, right_pixels_;  // of stretched pictures
};

}  // namespace armature
