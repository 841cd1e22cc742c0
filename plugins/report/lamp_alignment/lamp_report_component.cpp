// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>
#include <string>

#include "alignment_monitor.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/landmarks/landmark_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/target/target_messages.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/angles.hpp"
#include "error_table.hpp"
#include "following_monitor.hpp"
#include "report_lamp_alignment_ports.hpp"
#include "report_pictures.hpp"
#include "trajectory_hash.hpp"
#include "unfinished_scenario.hpp"

namespace armature::report::lamp_alignment {
namespace {

constexpr Duration kPeriod = seconds(0.02);
constexpr double kAtRest = 1e-7;  // [rad] between two samples of the arm

}  // namespace

class LampReport : public Component {
 public:
  explicit LampReport(Setup& setup)
      : Component(setup),
        model_{robot_of(setup)},
        light_axis_{model_.pointing_axis().value_or(Eigen::Vector3d::UnitX())},
        parameters_{Parameters::read(setup.params())},
        monitor_{parameters_},
        ports_{setup} {
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    see_truth(now);
    see_goals();
    read_arm(now);
    see_faces(now);
    if (ports_.task_state.latest()) see_task(*ports_.task_state.latest(), now);
    for (std::size_t i = 0; i < ports_.motion_status.size(); ++i) {
      constexpr std::uint8_t kAccepted = 0;
      if (ports_.motion_status[i].state_() == kAccepted) monitor_.see_new_goal();
    }
    keep_picture();
    monitor_.step(now);
    now_ = now;
  }

  bool finished() const override { return aborted_ || monitor_.finished(); }

  void summarize(Summary& summary) const override {
    if (aborted_) summary.failed("aborted", "by the operator");
    if (monitor_.face_not_found()) {
      summary.failed("face_not_found",
                     fmt::format("no face was found for {:g} s{}", parameters_.search_timeout,
                                 unfinished_.told(now_)));
    }
    const auto metric = [&](const char* key, const char* title, std::optional<double> value) {
      if (value) summary.metric(key, title, *value);
    };
    metric("time_to_find_s", "time to find the face [s]", monitor_.time_to_find_s());
    metric("time_to_align_s", "time to align [s]", monitor_.time_to_align_s());
    metric("time_to_realign_s", "time to align again after the move [s]",
           monitor_.time_to_realign_s());
    if (const auto error = monitor_.estimate_error()) {
      metric("mouth_position_error_mm", "mouth position error [mm]", 1000 * error->mouth.norm());
      const Eigen::Vector3d mouth_mm = 1000 * error->mouth;
      summary.series("mouth_error_mm", "  along x, y and z of the base [mm]",
                     {mouth_mm.x(), mouth_mm.y(), mouth_mm.z()});
      metric("face_normal_error_deg", "face normal error [deg]",
             kDegreesPerRad * error->normal_rad);
    }
    if (!monitor_.lamp_errors().empty()) {
      const LampError& last = monitor_.lamp_errors().back();
      metric("distance_mm", "final distance to the mouth [mm]", 1000 * last.distance_m);
      if (const auto error = last.distance_error_m) {
        metric("distance_error_mm", "its error [mm]", 1000 * *error);
      }
      metric("direction_error_deg", "direction error [deg]",
             kDegreesPerRad * last.direction_error_rad);
    }
    if (const auto& off = following_.worst()) {
      metric("following_spot_mm", "light off the mouth while the patient moves, at the worst [mm]",
             1000 * off->spot_m);
      metric("following_distance_mm", "  lamp off its distance [mm]", 1000 * off->distance_m);
      metric("following_angle_deg", "  light off the face's normal [deg]",
             kDegreesPerRad * off->angle_rad);
    }
    tell_pixels(summary);
    metric("replans", "goals after the first alignment", monitor_.replans());
    summary.text("trajectory_sha256", "SHA-256 of the arm's trajectory", hash_.hex());
    if (!monitor_.finished()) {
      summary.text(
          "missing", "what was missing at the end",
          fmt::format("{}{}", fmt::join(monitor_.missing(), "; "), unfinished_.told(now_)));
    }
  }

  void write_files(const std::filesystem::path& directory) const override {
    if (!picture_.gray.empty()) write_camera_picture(picture_, directory / "left_camera.png");
    write_error_plot(monitor_.lamp_errors(), parameters_, directory / "errors.png");
    write_error_table(monitor_.lamp_errors(), directory / "errors.csv");
  }

 private:
  /// Where the newest face is in both pictures.
  void tell_pixels(Summary& summary) const {
    if (!seen_) return;
    const auto tell = [&](const char* key, const char* title, FaceFeature feature) {
      std::vector<double> pixels;
      for (const FaceLandmarks* face : {&seen_->left, &seen_->right}) {
        const Eigen::Vector2d at = face->feature(feature).point;
        pixels.insert(pixels.end(), {at.x(), at.y()});
      }
      summary.series(key, title, std::move(pixels));
    };
    tell("left_eye_px", "left eye, u and v in the left and the right picture [px]",
         FaceFeature::left_eye);
    tell("right_eye_px", "right eye [px]", FaceFeature::right_eye);
    tell("mouth_px", "mouth [px]", FaceFeature::mouth);
  }

  void see_truth(Time now) {
    if (!ports_.truth.latest()) return;
    const auto truth = estimate_of(*ports_.truth.latest());
    if (!truth) return;
    monitor_.see_truth(*truth, now);
    following_.see_truth(*truth);
  }

  void see_faces(Time now) {
    for (std::size_t i = 0; i < ports_.landmarks.size(); ++i) {
      if (!ports_.landmarks[i].valid_()) continue;
      unfinished_.see_face(stamp_of(ports_.landmarks[i].header_().stamp_()));
      if (auto face = landmarks_of(ports_.landmarks[i])) seen_ = std::move(*face);
    }
    for (std::size_t i = 0; i < ports_.face.size(); ++i) {
      unfinished_.see_code(stamp_of(ports_.face[i].header_().stamp_()), ports_.face[i].code_());
    }
    for (std::size_t i = 0; i < ports_.target.size(); ++i) {
      const auto estimate = estimate_of(ports_.target[i]);
      if (estimate) {
        monitor_.see_estimate(*estimate, now);
        unfinished_.see_estimate();
      } else {
        unfinished_.see_refusal(stamp_of(ports_.target[i].header_().stamp_()),
                                estimate.error().text);
      }
    }
  }

  void see_task(const msg::TaskState& task, Time now) {
    const bool holds = task.state_() == "holding";
    monitor_.see_task(holds);
    if (holds) following_.see_hold();
    aborted_ = task.state_() == "aborted";
    const std::string part =
        task.steps_() == 0 ? "" : fmt::format(" {}/{}", task.step_(), task.steps_());
    unfinished_.see_task(task.state_() + part, task.detail_(), now);
  }

  void see_goals() {
    for (std::size_t i = 0; i < ports_.goal.size(); ++i) {
      const Eigen::Vector3d center = to_eigen(ports_.goal[i].position_());
      const Eigen::Vector3d mouth = to_eigen(ports_.goal[i].focus_());
      const bool for_a_face =
          ports_.goal[i].has_focus_() && center.allFinite() && mouth.allFinite();
      if (!for_a_face) continue;
      monitor_.see_goal(center, mouth);
      asked_m_ = (center - mouth).norm();
    }
  }

  void read_arm(Time now) {
    bool at_rest = true, heard = false;
    for (std::size_t i = 0; i < ports_.measured_js.size(); ++i) {
      const msg::JointState& measured = ports_.measured_js[i];
      hash_.add(stamp_of(measured.header_().stamp_()), measured.position_());
      const auto q = joints_of(model_, measured);
      if (!q) {
        degraded("measured_js: " + q.error().text);
        continue;
      }
      healthy();
      if (!last_q_ || (*q - *last_q_).cwiseAbs().maxCoeff() > kAtRest) at_rest = false;
      last_q_ = *q;
      last_stamp_ = stamp_of(measured.header_().stamp_());
      heard = true;
    }
    if (!heard) return;
    const Eigen::Isometry3d base_T_tool = forward_kinematics(model_, *last_q_);
    const Eigen::Vector3d light = base_T_tool.linear() * light_axis_;
    monitor_.see_lamp(base_T_tool.translation(), light, at_rest, last_stamp_, now);
    if (asked_m_) following_.see_lamp(base_T_tool.translation(), light, *asked_m_, last_stamp_);
  }

  /// The newest image whose landmarks, and face if any is told, are known already.
  void keep_picture() {
    const msg::Image* image = ports_.left_image.latest();
    const msg::FaceLandmarks* landmarks = ports_.landmarks.latest();
    const msg::CameraInfo* info = ports_.left_info.latest();
    if (!image || !landmarks || !info) return;
    const Time stamp = stamp_of(image->header_().stamp_());
    const msg::FacePose* face = ports_.face.latest();
    if (stamp != stamp_of(landmarks->header_().stamp_())) return;
    if (face && stamp != stamp_of(face->header_().stamp_())) return;
    if (image->data_().size() != std::size_t{image->width_()} * image->height_()) return;
    picture_.width = static_cast<int>(image->width_());
    picture_.height = static_cast<int>(image->height_());
    picture_.gray = image->data_();
    picture_.focal_px = info->k_()[0];
    picture_.cx = info->k_()[2];
    picture_.cy = info->k_()[5];
    picture_.landmarks.clear();
    const auto& left = landmarks->left_();
    for (std::size_t i = 0; landmarks->valid_() && i + 1 < left.size(); i += 2) {
      picture_.landmarks.emplace_back(left[i], left[i + 1]);
    }
    picture_.face.reset();
    if (!face || !face->valid_() || picture_.landmarks.empty()) return;
    const Eigen::Vector3d across = to_eigen(face->right_eye_()) - to_eigen(face->left_eye_());
    picture_.face = CameraPicture::FaceAxes{.mouth = to_eigen(face->mouth_()),
                                            .across = across.normalized(),
                                            .normal = to_eigen(face->normal_())};
  }

  RobotModel model_;
  Eigen::Vector3d light_axis_;
  Parameters parameters_;
  AlignmentMonitor monitor_;
  FollowingMonitor following_;
  std::optional<double> asked_m_;  // from the mouth, by the newest goal for a face
  UnfinishedScenario unfinished_;
  bool aborted_ = false;
  Time now_;
  TrajectoryHash hash_;
  CameraPicture picture_;
  std::optional<JointVector> last_q_;    // of the arm
  Time last_stamp_;                      // of that
  std::optional<StereoLandmarks> seen_;  // the newest
  Ports ports_;
};

}  // namespace armature::report::lamp_alignment

ARMATURE_PLUGIN(armature::report::lamp_alignment::LampReport);
