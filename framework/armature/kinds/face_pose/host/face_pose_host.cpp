// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/kinds/face_pose/frozen_cameras.hpp"
#include "armature/kinds/landmarks/landmark_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/guarded.hpp"
#include "host_face_pose_ports.hpp"
#include "row_drift.hpp"

namespace armature::host::face_pose {
namespace {

constexpr int kToldRepeats = 3;
constexpr Duration kTellEvery = seconds(10);  // its numbers change with every pair

/// The rectified pair whose right camera `info` describes and that took `image`.
Expected<StereoCamera> camera_of(const msg::CameraInfo& info, const ImageView& image) {
  const auto& p = info.p_();
  if (!(p[0] > 0) || !(p[3] < 0)) {
    return refuse(
        fmt::format("the right camera's info has f = {} px and P[3] = {}; a rectified "
                    "pair has f > 0 and P[3] = -f b < 0",
                    p[0], p[3]));
  }
  if (!std::isfinite(p[0]) || !std::isfinite(p[3]) || !std::isfinite(p[2]) ||
      !std::isfinite(p[6])) {
    return refuse("the right camera's info is not finite");
  }
  if (std::int64_t{info.width_()} != image.width || std::int64_t{info.height_()} != image.height) {
    return refuse(
        fmt::format("the right camera's info is for {} x {} pixels, the image has {} x {}",
                    info.width_(), info.height_(), image.width, image.height));
  }
  return StereoCamera{.width = static_cast<int>(info.width_()),
                      .height = static_cast<int>(info.height_()),
                      .focal_px = p[0],
                      .cx = p[2],
                      .cy = p[6],
                      .baseline_m = -p[3] / p[0]};
}

}  // namespace

/// Images and landmarks in, the face's pose out. What is wrong with the cameras is told in the
/// state.
class FacePoseHost final : public Component {
 public:
  explicit FacePoseHost(Setup& setup)
      : Component{setup},
        estimator_{setup.slot<FacePoseEstimator>("face_pose")},
        finder_{setup.optional_slot<LandmarkFinder>("landmarks")},
        ports_{setup},
        row_drift_{Parameters::read(setup.params())} {}

  void step(Time now) override;

 private:
  Expected<FacePose> estimate();
  bool is_frozen() const { return frozen_ && frozen_->repeats >= kToldRepeats; }
  std::optional<std::string> trouble() const;
  void tell(Time now);

  Slot<FacePoseEstimator> estimator_;
  std::optional<Slot<LandmarkFinder>> finder_;
  PluginState state_;
  Ports ports_;
  FrozenCameras cameras_;
  RowDrift row_drift_;
  std::optional<FrozenCameras::Frozen> frozen_;  // the last pair, which is no pair then
  std::optional<Time> told_;
  std::string told_frozen_;
};

Expected<FacePose> FacePoseHost::estimate() {
  using enum FaceRefusal;
  frozen_.reset();
  const auto left = image_of(*ports_.left_image.latest());
  const auto right = image_of(*ports_.right_image.latest());
  if (!left) return refuse(bad_input, "left: " + left.error().text);
  if (!right) return refuse(bad_input, "right: " + right.error().text);
  frozen_ = cameras_.look_at(*left, *right);
  if (frozen_) return refuse(bad_input, frozen_->why);
  if (!ports_.landmarks.latest()->valid_()) {
    return refuse(no_face, ports_.landmarks.latest()->reason_());
  }
  if (!ports_.right_info.latest()) return refuse(bad_input, "no camera_info yet");
  const auto landmarks = landmarks_of(*ports_.landmarks.latest());
  if (!landmarks) return refuse(bad_input, landmarks.error().text);
  const auto camera = camera_of(*ports_.right_info.latest(), *right);
  if (!camera) return refuse(bad_input, camera.error().text);
  return guarded(state_, [&](PluginState& state) {
    return estimator_->estimate({.left = *left,
                                 .right = *right,
                                 .landmarks = *landmarks,
                                 .camera = *camera,
                                 .finder = finder_ ? &**finder_ : nullptr},
                                state);
  });
}

/// The fault of the cameras to tell in the state, if there is one. A picture that has come again
/// once or twice is refused, but is no fault of a camera yet.
std::optional<std::string> FacePoseHost::trouble() const {
  if (is_frozen()) return frozen_->why;
  const msg::CameraInfo* info = ports_.right_info.latest();
  if (!info) return std::nullopt;
  return row_drift_.warning(static_cast<int>(info->width_()), static_cast<int>(info->height_()));
}

void FacePoseHost::tell(Time now) {
  const auto wrong = trouble();
  if (!wrong) {
    told_.reset();
    return healthy();
  }
  std::string frozen = is_frozen() ? frozen_->why : "";
  if (told_ && told_frozen_ == frozen && now - *told_ < kTellEvery) return;
  told_ = now;
  told_frozen_ = std::move(frozen);
  degraded(*wrong);
}

void FacePoseHost::step(Time now) {
  if (!ports_.landmarks.fresh() || !ports_.landmarks.latest() || !ports_.left_image.latest() ||
      !ports_.right_image.latest()) {
    return;
  }
  const auto estimated = estimate();
  if (estimated && estimated->rows) row_drift_.add(*estimated->rows);
  tell(now);
  const FacePose pose = estimated.value_or(FacePose{});
  auto face = ports_.face.loan();
  face->header_() = ports_.landmarks.latest()->header_();
  face->valid_(estimated.has_value());
  const Reason reason = estimated ? Reason{} : estimated.error();
  face->reason_(reason.text);
  face->code_(reason.code);
  assign(face->left_eye_(), pose.left_eye);
  assign(face->right_eye_(), pose.right_eye);
  assign(face->mouth_(), pose.mouth);
  assign(face->normal_(), pose.normal);
  assign(face->left_eye_covariance_(), pose.left_eye_covariance);
  assign(face->right_eye_covariance_(), pose.right_eye_covariance);
  assign(face->mouth_covariance_(), pose.mouth_covariance);
  assign(face->normal_covariance_(), pose.normal_covariance);
  face->residual_px_(pose.residual_px);
  face.publish();
}

}  // namespace armature::host::face_pose

ARMATURE_PLUGIN(armature::host::face_pose::FacePoseHost);
