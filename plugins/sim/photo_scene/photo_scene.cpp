// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "armature/kinds/geometry_params.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/target/target_messages.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/scene/generated_face.hpp"
#include "armature/scene/plane_renderer.hpp"
#include "patient.hpp"
#include "photo_file.hpp"

namespace armature::sim::photo_scene {
namespace {

constexpr const char* kCameraFrame = kLeftCameraFrame;  // of both: the pair is rectified

scene::Photo photo_of(const Parameters& parameters) {
  if (parameters.photo == Parameters::Photo::generated) {
    return scene::generated_face(parameters.face_seed, parameters.eye_distance);
  }
  // Eyes and mouth of NASA's portrait of Eileen Collins, in its pixels.
  auto photo = read_photo(parameters.astronaut_file, {203.6, 101.8}, {246.9, 104.0}, {223.1, 144.4},
                          parameters.eye_distance);
  if (!photo) {
    throw SetupError(photo.error().text +
                     "; install the Debian package python3-imageio, or set photo: generated");
  }
  return std::move(*photo);
}

Parameters parameters_of(const Params& params) {
  const Parameters parameters = Parameters::read(params);
  const bool moves = !vector_of(parameters.move).isZero(0) || parameters.move_tilt_up != 0 ||
                     parameters.move_tilt_side != 0;
  if (parameters.move_duration > 0 && !moves) {
    throw SetupError(
        "move_duration_s is set but nothing moves; set move_mm, move_tilt_up_deg or "
        "move_tilt_side_deg, or move_duration_s to 0");
  }
  return parameters;
}

msg::CameraInfo camera_info(const StereoCamera& camera, double offset_m) {
  const double f = camera.focal_px;
  msg::CameraInfo info;
  info.header_().frame_id_(kCameraFrame);
  info.width_(static_cast<std::uint32_t>(camera.width));
  info.height_(static_cast<std::uint32_t>(camera.height));
  info.distortion_model_("plumb_bob");
  info.d_().assign(5, 0.0);
  info.k_(std::array<double, 9>{f, 0, camera.cx, 0, f, camera.cy, 0, 0, 1});
  info.r_(std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1});
  info.p_(std::array<double, 12>{f, 0, camera.cx, -f * offset_m, 0, f, camera.cy, 0, 0, 0, 1, 0});
  return info;
}

}  // namespace

/// The patient, as a photo on a plane, in front of the arm's two cameras.
class PhotoScene final : public Component {
 public:
  explicit PhotoScene(Setup& setup);
  void step(Time now) override;

 private:
  void publish_truth(Time now, const MovingHead& head);
  void take_pictures(Time stamp, const JointVector& q, const HeadPose& head);
  void publish_info(Time stamp);

  RobotModel robot_;
  StereoRig rig_;
  FrameId mount_;
  Parameters parameters_;
  scene::PlaneRenderer renderer_;
  Input<msg::JointState> measured_js_;
  Input<msg::LightLevel> light_level_;
  Input<msg::Capture> capture_;
  Output<msg::Image> left_image_, right_image_;
  Output<msg::CameraInfo> left_info_, right_info_;
  Output<msg::Target> truth_;
  std::optional<Time> start_, last_picture_;
  std::uint64_t pictures_ = 0;
};

PhotoScene::PhotoScene(Setup& setup)
    : Component{setup},
      robot_{robot_of(setup)},
      rig_{rig_of(setup)},
      mount_{mount_of(rig_, robot_)},
      parameters_{parameters_of(setup.params())},
      renderer_{photo_of(parameters_),
                {.noise = parameters_.noise,
                 .blur_px = parameters_.blur,
                 .background = parameters_.background},
                setup.seed()},
      measured_js_{setup.input<msg::JointState>("measured_js")},
      light_level_{setup.input<msg::LightLevel>("light_level")},
      capture_{setup.input<msg::Capture>("capture")},
      left_image_{setup.output<msg::Image>("left_image")},
      right_image_{setup.output<msg::Image>("right_image")},
      left_info_{setup.output<msg::CameraInfo>("left_info")},
      right_info_{setup.output<msg::CameraInfo>("right_info")},
      truth_{setup.output<msg::Target>("truth")} {
  if (rig_.camera.width > scene::PlaneRenderer::kWidestImage) {
    throw SetupError("the rig '" + rig_.name + "' is " + std::to_string(rig_.camera.width) +
                     " px wide; the scene draws at most " +
                     std::to_string(scene::PlaneRenderer::kWidestImage));
  }
  setup.activate_every(seconds(1.0 / parameters_.rate));
}

void PhotoScene::step(Time now) {
  if (!start_) start_ = now;
  publish_truth(now, at(parameters_, to_seconds(now - *start_)));

  if (capture_.latest() && !capture_.latest()->on_()) return;
  const msg::JointState* arm = measured_js_.latest();
  if (!arm) return;
  const Time stamp = stamp_of(arm->header_().stamp_());
  if (last_picture_ && stamp <= *last_picture_) return;
  const auto q = joints_of(robot_, *arm);
  if (!q) return degraded("measured_js: " + q.error().text);
  healthy();
  if (!last_picture_) publish_info(stamp);
  last_picture_ = stamp;
  take_pictures(stamp, *q, at(parameters_, to_seconds(stamp - *start_)).pose);
}

void PhotoScene::publish_truth(Time now, const MovingHead& head) {
  auto truth = truth_.loan();
  write_estimate({.stamp = now,
                  .position = head.pose.mouth,
                  .normal = face_normal(head.pose),
                  .velocity = head.velocity,
                  .normal_rate = head.normal_rate,
                  .measurements = 1},
                 *truth);
  truth.publish();
}

void PhotoScene::publish_info(Time stamp) {
  for (auto* output : {&left_info_, &right_info_}) {
    msg::CameraInfo info =
        camera_info(rig_.camera, output == &left_info_ ? 0 : rig_.camera.baseline_m);
    set_stamp(info.header_().stamp_(), stamp);
    output->publish(info);
  }
}

void PhotoScene::take_pictures(Time stamp, const JointVector& q, const HeadPose& head) {
  const double light = light_level_.latest() ? light_level_.latest()->level_() : 0.0;
  const double brightness =
      parameters_.gain * (1 + parameters_.light_response * std::clamp(light, 0.0, 1.0));
  const Eigen::Isometry3d base_T_left = forward_kinematics(robot_, q, mount_) * rig_.mount_T_left;
  Eigen::Isometry3d camera_T_photo = base_T_left.inverse() * base_T_photo(head);
  for (auto* output : {&left_image_, &right_image_}) {
    auto image = output->loan();
    write_header(image->header_(), stamp, kCameraFrame);
    image->width_(static_cast<std::uint32_t>(rig_.camera.width));
    image->height_(static_cast<std::uint32_t>(rig_.camera.height));
    image->step_(static_cast<std::uint32_t>(rig_.camera.width));
    image->encoding_("mono8");
    image->is_bigendian_(0);
    image->data_().resize(std::size_t{image->width_()} * image->height_());
    renderer_.render(camera_T_photo, rig_.camera, brightness, pictures_++, image->data_());
    image.publish();
    camera_T_photo.pretranslate(Eigen::Vector3d{-rig_.camera.baseline_m, 0, 0});  // next: the right
  }
}

}  // namespace armature::sim::photo_scene

ARMATURE_PLUGIN(armature::sim::photo_scene::PhotoScene);
