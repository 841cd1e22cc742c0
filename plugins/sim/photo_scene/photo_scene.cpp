// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>

#include "appearance.hpp"
#include "armature/kinds/geometry_params.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/target/target_messages.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/scene/right_camera.hpp"
#include "armature/scene/scene_renderer.hpp"
#include "armature/scene/splitmix.hpp"
#include "armature/values/chance.hpp"
#include "patient.hpp"
#include "pose_history.hpp"
#include "sim_photo_scene_ports.hpp"

namespace armature::sim::photo_scene {
namespace {

constexpr const char* kCameraFrame = kLeftCameraFrame;  // of both: the pair is rectified

Parameters parameters_of(const Params& params) {
  const Parameters parameters = Parameters::read(params);
  const bool moves = !vector_of(parameters.move).isZero(0) || parameters.move_tilt_up != 0 ||
                     parameters.move_tilt_side != 0;
  if (parameters.dropped + parameters.repeated > 1) {
    throw SetupError(
        fmt::format("dropped and repeated are parts of all pairs, and {} + {} is "
                    "more than 1",
                    parameters.dropped, parameters.repeated));
  }
  const bool occluder_comes = parameters.occluder_at > 0 || parameters.occluder_duration > 0;
  if (occluder_comes && parameters.occluder == Parameters::Occluder::none) {
    params.refuse({"occluder_at_s", "occluder_duration_s"},
                  "occluder_at_s or occluder_duration_s is set but there is no occluder; name one");
  }
  if (parameters.move_duration > 0 && !moves) {
    throw SetupError(
        "move_duration_s is set but nothing moves; set move_mm, move_tilt_up_deg or "
        "move_tilt_side_deg, or move_duration_s to 0");
  }
  if (2 * parameters.move_ramp > parameters.move_duration) {
    params.refuse(
        {"move_ramp_s", "move_duration_s"},
        fmt::format("two ramps of move_ramp_s, {:g}, do not fit into move_duration_s, {:g}",
                    parameters.move_ramp, parameters.move_duration));
  }
  return parameters;
}

scene::SceneRenderer renderer_of(const Parameters& parameters, std::uint64_t seed) {
  const scene::Photo photo = photo_of(parameters);
  return {photo, staging_of(parameters, photo), imaging_of(parameters), seed};
}

/// Of the face without the occluder, where that does not stay from the start to the end.
std::optional<scene::SceneRenderer> uncovered_renderer_of(Parameters parameters,
                                                          std::uint64_t seed) {
  if (parameters.occluder_at == 0 && parameters.occluder_duration == 0) return std::nullopt;
  parameters.occluder = Parameters::Occluder::none;
  return renderer_of(parameters, seed);
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
  enum class Delivery { sound, dropped, repeated };
  Delivery draw_delivery();
  bool is_frozen(bool of_the_left, Time stamp) const;
  double brightness(Time stamp) const;
  scene::SceneRenderer& renderer_at(Time stamp);
  bool keeps_last_pair() const {
    return parameters_.repeated > 0 || parameters_.frozen != Parameters::Frozen::none;
  }
  void take_pictures(Time stamp);
  void draw(Time stamp, bool of_the_left, msg::Image& image);
  Eigen::Isometry3d left_T_face(Time then) const;
  void publish_info(Time stamp);

  RobotModel robot_;
  StereoRig rig_;
  FrameId mount_;
  Parameters parameters_;
  scene::SceneRenderer renderer_;
  std::optional<scene::SceneRenderer> uncovered_;  // while the occluder is not there
  scene::RightCamera right_camera_;
  PoseHistory base_T_left_;
  std::uint64_t seed_;
  Ports ports_;
  std::optional<Time> start_, last_picture_;
  std::uint64_t pairs_ = 0;
  int truths_ = 0;                       // told
  std::array<msg::Image, 2> last_pair_;  // kept where pictures may come again
};

PhotoScene::PhotoScene(Setup& setup)
    : Component{setup},
      robot_{robot_of(setup)},
      rig_{rig_of(setup)},
      mount_{mount_of(rig_, robot_)},
      parameters_{parameters_of(setup.params())},
      renderer_{renderer_of(parameters_, setup.seed())},
      uncovered_{uncovered_renderer_of(parameters_, setup.seed())},
      right_camera_{right_camera_of(parameters_)},
      base_T_left_{parameters_.right_delay},
      seed_{setup.seed()},
      ports_{setup} {
  if (rig_.camera.width > scene::SceneRenderer::kWidestImage) {
    throw SetupError("the rig '" + rig_.name + "' is " + std::to_string(rig_.camera.width) +
                     " px wide; the scene draws at most " +
                     std::to_string(scene::SceneRenderer::kWidestImage));
  }
  setup.activate_every(seconds(1.0 / parameters_.rate));
}

void PhotoScene::step(Time now) {
  if (!start_) start_ = now;
  publish_truth(now, at(parameters_, to_seconds(now - *start_)));

  if (ports_.capture.latest() && !ports_.capture.latest()->on_()) return;
  const msg::JointState* arm = ports_.measured_js.latest();
  if (!arm) return;
  const Time stamp = stamp_of(arm->header_().stamp_());
  if (last_picture_ && stamp <= *last_picture_) return;
  const auto q = joints_of(robot_, *arm);
  if (!q) return degraded("measured_js: " + q.error().text);
  healthy();
  if (!last_picture_) publish_info(stamp);
  last_picture_ = stamp;
  base_T_left_.add(stamp, forward_kinematics(robot_, *q, mount_) * rig_.mount_T_left);
  take_pictures(stamp);
}

void PhotoScene::publish_truth(Time now, const MovingHead& head) {
  const TurningDirection normal = carried(head, renderer_.truth().normal());
  auto truth = ports_.truth.loan();
  write_estimate({.stamp = now,
                  .position = head.pose.mouth,
                  .normal = normal.direction,
                  .velocity = head.velocity,
                  .normal_rate = normal.rate,
                  .measurements = ++truths_},
                 *truth);
  truth.publish();
}

void PhotoScene::publish_info(Time stamp) {
  for (auto* output : {&ports_.left_info, &ports_.right_info}) {
    msg::CameraInfo info =
        camera_info(rig_.camera, output == &ports_.left_info ? 0 : rig_.camera.baseline_m);
    set_stamp(info.header_().stamp_(), stamp);
    output->publish(info);
  }
}

double PhotoScene::brightness(Time stamp) const {
  const double light = ports_.light_level.latest() ? ports_.light_level.latest()->level_() : 0.0;
  const double turns = parameters_.flicker_hz * to_seconds(stamp - *start_);
  return parameters_.gain * (1 + parameters_.light_response * std::clamp(light, 0.0, 1.0)) *
         (1 + parameters_.flicker * std::sin(2 * std::numbers::pi * turns));
}

scene::SceneRenderer& PhotoScene::renderer_at(Time stamp) {
  const double since = to_seconds(stamp - *start_) - parameters_.occluder_at;
  const bool gone = parameters_.occluder_duration > 0 && since >= parameters_.occluder_duration;
  return uncovered_ && (since < 0 || gone) ? *uncovered_ : renderer_;
}

PhotoScene::Delivery PhotoScene::draw_delivery() {
  const double drawn = share_of(scene::splitmix(seed_ + ++pairs_));
  if (drawn < parameters_.dropped) return Delivery::dropped;
  const bool repeats = pairs_ > 1 && drawn < parameters_.dropped + parameters_.repeated;
  return repeats ? Delivery::repeated : Delivery::sound;
}

/// The face before the left camera, where patient and arm were then.
Eigen::Isometry3d PhotoScene::left_T_face(Time then) const {
  return base_T_left_.at(then).inverse() *
         base_T_photo(at(parameters_, to_seconds(then - *start_)).pose);
}

bool PhotoScene::is_frozen(bool of_the_left, Time stamp) const {
  using enum Parameters::Frozen;
  const auto which = parameters_.frozen;
  return (which == both || which == (of_the_left ? left : right)) &&
         to_seconds(stamp - *start_) >= parameters_.frozen_at;
}

void PhotoScene::take_pictures(Time stamp) {
  const Delivery delivery = draw_delivery();
  if (delivery == Delivery::dropped) return;
  for (const bool of_the_left : {true, false}) {
    Output<msg::Image>& output = of_the_left ? ports_.left_image : ports_.right_image;
    msg::Image& last = last_pair_[of_the_left ? 0 : 1];
    auto image = output.loan();
    const bool comes_again = delivery == Delivery::repeated || is_frozen(of_the_left, stamp);
    if (comes_again && !last.data_().empty()) {
      *image = last;
    } else {
      draw(stamp, of_the_left, *image);
    }
    write_header(image->header_(), stamp, kCameraFrame);
    if (keeps_last_pair()) last = *image;
    image.publish();
  }
}

void PhotoScene::draw(Time stamp, bool of_the_left, msg::Image& image) {
  image.width_(static_cast<std::uint32_t>(rig_.camera.width));
  image.height_(static_cast<std::uint32_t>(rig_.camera.height));
  image.step_(static_cast<std::uint32_t>(rig_.camera.width));
  image.encoding_("mono8");
  image.is_bigendian_(0);
  image.data_().resize(std::size_t{image.width_()} * image.height_());
  const std::uint64_t picture = 2 * (pairs_ - 1) + (of_the_left ? 0 : 1);
  if (of_the_left) {
    renderer_at(stamp).render(left_T_face(stamp), rig_.camera, brightness(stamp), picture,
                              image.data_());
    return;
  }
  const Time seen_at = stamp - seconds(parameters_.right_delay);
  const Eigen::Isometry3d right_T_face =
      right_camera_.right_T_left(rig_.camera) * left_T_face(seen_at);
  renderer_at(seen_at).render(right_T_face, right_camera_.of(rig_.camera),
                              right_camera_.gain * brightness(stamp), picture, image.data_());
}

}  // namespace armature::sim::photo_scene

ARMATURE_PLUGIN(armature::sim::photo_scene::PhotoScene);
