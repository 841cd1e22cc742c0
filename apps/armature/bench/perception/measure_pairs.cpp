// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/measure_pairs.hpp"

#include <cmath>
#include <utility>

#include "armature/kinds/face_pose/frozen_cameras.hpp"
#include "armature/kinds/landmarks/stereo_face_finder.hpp"
#include "armature/values/guarded.hpp"
#include "bench/clock.hpp"
#include "bench/perception/finder_bias.hpp"
#include "bench/perception/stage.hpp"

namespace armature::bench {
namespace {

/// What `call` gives; the time that it took is added to `seconds`.
template <class Call>
auto timed(double& seconds, Call&& call) {
  const auto start = Clock::now();
  auto answer = std::forward<Call>(call)();
  seconds += seconds_between(start, Clock::now());
  return answer;
}

class TimedDetector final : public FaceDetector {
 public:
  explicit TimedDetector(FaceDetector& detector) : detector_{detector} {}
  Expected<std::vector<DetectedFace>> detect(const ImageView& image,
                                             const SearchRegion& region) override {
    double took = 0;
    auto faces = timed(took, [&] { return detector_.detect(image, region); });
    if (calls == 0) first = took;
    seconds += took;
    ++calls;
    return faces;
  }
  double seconds = 0, first = 0;
  int calls = 0;

 private:
  FaceDetector& detector_;
};

class TimedLandmarks final : public LandmarkFinder {
 public:
  explicit TimedLandmarks(LandmarkFinder& finder) : finder_{finder} {}
  LandmarkScheme scheme() const override { return finder_.scheme(); }
  Expected<std::vector<Landmark>> find(const ImageView& image, const PixelBox& face) override {
    return timed(seconds, [&] { return finder_.find(image, face); });
  }
  double seconds = 0;

 private:
  LandmarkFinder& finder_;
};

/// The states of finder and estimator, kept from pair to pair, and what their host keeps.
struct Memory {
  FrozenCameras cameras;
  StereoFaceFinder::State finder;
  PluginState estimator;
};

PairResult measure_pair(const PerceptionCase& one, const StagedPair& pair,
                        const MeasuredPlugins& plugins, Memory& memory) {
  TimedDetector detector{plugins.detector};
  TimedLandmarks landmarks{plugins.landmarks};
  StereoFaceFinder finder{detector, landmarks, plugins.search};
  PairResult result{.group = one.group,
                    .number = one.number,
                    .face_seed = one.face_seed,
                    .is_tracked = one.continues,
                    .truth = pair.truth};
  const auto frozen = memory.cameras.look_at(pair.left.view(), pair.right.view());
  const auto found = guarded(memory.finder, [&](StereoFaceFinder::State& state) {
    return finder.find(pair.left.view(), pair.right.view(), state);
  });
  if (!one.continues && detector.calls > 0) result.times.full_pass = detector.first;
  result.times.detector = detector.seconds;
  result.times.landmarks = landmarks.seconds;
  result.detected = found.has_value();
  if (!found) {
    result.reason = found.error().text;
    return result;
  }
  if (frozen) {
    result.reason = frozen->why;
    return result;
  }
  double took = 0;
  const auto pose = timed(took, [&] {
    return guarded(memory.estimator, [&](PluginState& state) {
      return plugins.estimator.estimate({.left = pair.left.view(),
                                         .right = pair.right.view(),
                                         .landmarks = *found,
                                         .camera = one.camera,
                                         .finder = plugins.of_estimator},
                                        state);
    });
  });
  result.times.estimator = took;
  if (!pose) {
    result.reason = pose.error().text.empty() ? "no reason" : pose.error().text;
    return result;
  }
  result.pose = *pose;
  result.drawn = error_of(*pose, pair.truth);
  return result;
}

}  // namespace

PoseError error_of(const FacePose& pose, const scene::FacePoints& truth) {
  const Eigen::Vector3d normal = truth.normal();
  return {.mouth_m = (pose.mouth - truth.mouth).norm(),
          .normal_rad = std::atan2(pose.normal.cross(normal).norm(), pose.normal.dot(normal))};
}

// An error that is not a number is wrong, too.
bool PairResult::is_wrong() const {
  return pose && !(drawn.mouth_m <= kMaxMouthError_m && drawn.normal_rad <= kMaxNormalError_rad);
}

std::vector<PairResult> measure_pairs(const std::vector<PerceptionCase>& cases,
                                      const MeasuredPlugins& plugins,
                                      const std::function<void(std::size_t)>& progress) {
  std::vector<PairResult> results;
  Stage stage;
  FinderBias bias{plugins.detector, plugins.landmarks};
  Memory memory;
  for (const PerceptionCase& one : cases) {
    if (!one.continues) memory = {};
    results.push_back(measure_pair(one, stage.take(one), plugins, memory));
    PairResult& result = results.back();
    if (result.pose) {
      const auto found = bias.points(one, stage);
      if (found) result.stereo_only = error_of(*result.pose, *found);
    }
    progress(results.size());
  }
  return results;
}

}  // namespace armature::bench
