// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "armature/kinds/detector/detector.hpp"
#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/scene/surface.hpp"
#include "bench/perception/stage.hpp"

namespace armature::bench {

/// Where a finder takes eyes and mouth of a face to be, apart from what noise and perspective do:
/// the mean over exact frontal pictures of it, each a little elsewhere. What an estimate differs
/// from that is the stereo's own error; what that differs from the drawn points is the finder's.
class FinderBias {
 public:
  FinderBias(FaceDetector& detector, LandmarkFinder& finder)
      : detector_{detector}, finder_{finder} {}

  /// The points of a case in the left camera's frame [m], as the finder takes them; nothing for a
  /// face that the detector does not find.
  std::optional<scene::FacePoints> points(const PerceptionCase& one, Stage& stage);

 private:
  struct Features {  // [m] on the flat photo, from the drawn mouth
    Eigen::Vector2d left_eye, right_eye, mouth;
  };
  std::optional<Features> measure(const scene::Photo& photo);

  FaceDetector& detector_;
  LandmarkFinder& finder_;
  std::map<std::uint64_t, std::optional<Features>> known_;
};

}  // namespace armature::bench
