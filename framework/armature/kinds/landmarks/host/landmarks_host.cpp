// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/landmarks/landmark_messages.hpp"
#include "armature/kinds/landmarks/stereo_face_finder.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/guarded.hpp"
#include "host_landmarks_parameters.hpp"
#include "host_landmarks_ports.hpp"

namespace armature::host::landmarks {
namespace {

StereoFaceFinder::Options options_of(const Parameters& parameters) {
  return {.stretch_below = parameters.stretch_below, .detect_every = parameters.detect_every};
}

}  // namespace

/// Images in, landmarks out.
class LandmarksHost final : public Component {
 public:
  explicit LandmarksHost(Setup& setup)
      : Component{setup},
        detector_{setup.slot<FaceDetector>("detector")},
        landmark_finder_{setup.slot<LandmarkFinder>("landmarks")},
        finder_{*detector_, *landmark_finder_, options_of(Parameters::read(setup.params()))},
        ports_{setup} {}

  void step(Time) override;

 private:
  Expected<StereoLandmarks> find(const msg::Image& left, const msg::Image& right);

  Slot<FaceDetector> detector_;
  Slot<LandmarkFinder> landmark_finder_;
  StereoFaceFinder finder_;
  StereoFaceFinder::State state_;
  Ports ports_;
};

Expected<StereoLandmarks> LandmarksHost::find(const msg::Image& left, const msg::Image& right) {
  const auto left_view = image_of(left), right_view = image_of(right);
  if (!left_view) return refuse("left: " + left_view.error().text);
  if (!right_view) return refuse("right: " + right_view.error().text);
  return guarded(state_, [&](StereoFaceFinder::State& state) {
    return finder_.find(*left_view, *right_view, state);
  });
}

void LandmarksHost::step(Time) {
  if (!ports_.left_image.fresh() || !ports_.left_image.latest() || !ports_.right_image.latest()) {
    return;
  }
  const msg::Image& left = *ports_.left_image.latest();
  const auto found = find(left, *ports_.right_image.latest());

  auto answer = ports_.landmarks.loan();
  answer->header_() = left.header_();
  const auto view = image_of(left);
  answer->image_intensity_(view ? mean_intensity(*view, whole(*view)) : 0.0);
  if (found) {
    write_landmarks(*found, *answer);
  } else {
    write_no_landmarks(found.error().text, *answer);
  }
  answer.publish();
}

}  // namespace armature::host::landmarks

ARMATURE_PLUGIN(armature::host::landmarks::LandmarksHost);
