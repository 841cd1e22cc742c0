// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "armature/kinds/detector/detector.hpp"
#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/kinds/landmarks/stereo_face_finder.hpp"
#include "armature/scene/surface.hpp"
#include "bench/perception/cases.hpp"

namespace armature::bench {

/// A valid estimate is wrong when it is farther than this from what was drawn.
inline constexpr double kMaxMouthError_m = 0.005;
inline constexpr double kMaxNormalError_rad = 3 * 3.14159265358979323846 / 180;

/// The distance of an estimate from points.
struct PoseError {
  double mouth_m = 0, normal_rad = 0;
};
PoseError error_of(const FacePose& pose, const scene::FacePoints& truth);

/// What a pair took, [s]; of two pictures together unless it says otherwise.
struct StageTimes {
  std::optional<double> full_pass;  // of the detector over the whole left picture, a pair's first
  double detector = 0, landmarks = 0;
  std::optional<double> estimator;  // of pairs with landmarks
};

/// What became of one pair.
struct PairResult {
  std::string group;
  int number = 0;
  std::uint64_t face_seed = 0;
  bool is_tracked = false;  // what was remembered of the pair before was kept
  bool detected = false;    // landmarks were found in both pictures
  std::string reason;       // why there is no valid pose; empty: there is one
  scene::FacePoints truth;
  std::optional<FacePose> pose;          // of a valid one
  PoseError drawn;                       // against what was drawn
  std::optional<PoseError> stereo_only;  // against where the finder takes the points to be
  StageTimes times;

  bool is_wrong() const;
};

struct MeasuredPlugins {
  FaceDetector& detector;
  LandmarkFinder& landmarks;
  FacePoseEstimator& estimator;
  LandmarkFinder* of_estimator;  // which it asks again; nullptr: there is none
  StereoFaceFinder::Options search;
};

/// Finds the face of every case and estimates its pose, one after the other. An exception out of a
/// plugin is a reason like any other. `progress` is told how many of all are done.
std::vector<PairResult> measure_pairs(const std::vector<PerceptionCase>& cases,
                                      const MeasuredPlugins& plugins,
                                      const std::function<void(std::size_t)>& progress);

}  // namespace armature::bench
