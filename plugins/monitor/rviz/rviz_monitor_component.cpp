// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <utility>

#include "armature/kinds/geometry_params.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/registration_dialogue.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/motion/goal.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/execution/rate_limiter.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "frame_tree.hpp"
#include "image_in_base.hpp"
#include "picture.hpp"
#include "plan_picture.hpp"
#include "urdf_text.hpp"

namespace armature::monitor::rviz {
namespace {

FrameTree tree_of(const Parameters& parameters, const Params& params, const RobotModel& model,
                  const std::optional<StereoRig>& rig) {
  if (rig) mount_of(*rig, model);  // or it refuses
  const Eigen::Isometry3d world_T_base = pose_of(parameters.base_position, parameters.base_rpy);
  if (parameters.world_frame.empty() && !world_T_base.isApprox(Eigen::Isometry3d::Identity())) {
    params.refuse({"base_position_m", "base_rpy_deg"},
                  "'base_position_m' and 'base_rpy_deg' place base in 'world_frame': name one");
  }
  auto tree = FrameTree::make(model, rig, parameters);
  if (!tree) throw SetupError(tree.error().text);
  return std::move(*tree);
}

}  // namespace

/// The system as ROS tools like to see it. Nobody in the deployment reads what it writes.
class RvizMonitor final : public Component {
 public:
  explicit RvizMonitor(Setup& setup)
      : Component{setup},
        model_{robot_of(setup)},
        parameters_{Parameters::read(setup.params())},
        tree_{tree_of(parameters_, setup.params(), model_, optional_rig_of(setup))},
        picture_{model_, tree_, parameters_},
        rate_limiter_{seconds(1 / parameters_.rate)},
        marker_rate_limiter_{seconds(1 / parameters_.marker_rate)},
        measured_js_{setup.input<msg::JointState>("measured_js")},
        target_{setup.input<msg::Target>("target")},
        truth_{setup.input<msg::Target>("truth")},
        face_{setup.input<msg::FacePose>("face")},
        path_{setup.input<msg::ToolPath>("path")},
        motion_status_{setup.input<msg::MotionStatus>("motion_status")},
        needle_plan_{setup.input<msg::NeedlePlan>("needle_plan")},
        implant_plan_{setup.input<msg::ImplantPlan>("implant_plan")},
        registration_{setup},
        chain_{setup.input<msg::TFMessage>("chain")},
        incision_{setup.input<msg::PointStamped>("incision")},
        goal_{setup.input<msg::MotionGoal>("goal")},
        tf_{setup.output<msg::TFMessage>("tf")},
        tf_static_{setup.output<msg::TFMessage>("tf_static")},
        joint_states_{setup.output<msg::JointState>("joint_states")},
        tool_pose_{setup.output<msg::PoseStamped>("tool_pose")},
        markers_{setup.output<msg::MarkerArray>("markers")},
        plan_markers_{setup.output<msg::MarkerArray>("plan_markers")},
        robot_description_{setup.output<msg::String>("robot_description")} {
    setup.activate_every(seconds(1 / parameters_.rate));
  }

  void step(Time now) override {
    for (std::size_t i = 0; i < motion_status_.size(); ++i) goals_.see(motion_status_[i]);
    publish_what_never_changes(now);
    if (hear_plans()) publish_plans(now);
    if (!rate_limiter_.due(now)) return;
    const msg::JointState* arm = measured_js_.latest();
    if (!arm) return;
    const auto q = joints_of(model_, *arm);
    if (!q) return degraded("measured_js: " + q.error().text);
    healthy();
    const Time stamp = stamp_of(arm->header_().stamp_());
    if (!published_at_ || stamp > *published_at_) {
      publish_frames(*q, stamp);
      publish_joints(*arm);
      publish_tool_pose(*q, stamp);
      published_at_ = stamp;
    }
    if (marker_rate_limiter_.due(now)) publish_markers(*q, stamp);
  }

 private:
  /// Once: DDS keeps them for those who come later.
  void publish_what_never_changes(Time now) {
    if (std::exchange(told_once_, true)) return;
    auto fixed = tf_static_.loan();
    tree_.write_fixed(now, *fixed);
    fixed.publish();
    auto description = robot_description_.loan();
    description->data_(urdf_text(model_, tree_));
    description.publish();
  }

  /// True when something is known that was not before.
  bool hear_plans() {
    bool is_news = needle_plan_.fresh() || implant_plan_.fresh() || incision_.fresh();
    registration_.listen([&](const msg::RegistrationResponse& answer) {
      image_.hear(answer);
      is_news = true;
    });
    if (chain_.fresh()) image_.hear(*chain_.latest());
    return hear_goals() || is_news || chain_.fresh();
  }

  /// True when the arm is on another way: a pause, going on and going back are the same one.
  bool hear_goals() {
    bool is_news = false;
    for (std::size_t i = 0; i < goal_.size(); ++i) {
      switch (static_cast<MotionMode>(goal_[i].mode_())) {
        case MotionMode::planned:
          way_ = goal_[i];
          is_news = true;
          break;
        case MotionMode::pause:
        case MotionMode::resume:
        case MotionMode::retrace:
          break;
        default:
          is_news = std::exchange(way_, std::nullopt).has_value() || is_news;
      }
    }
    return is_news;
  }

  /// Once for each change: DDS keeps the last array for those who come later.
  void publish_plans(Time now) {
    auto markers = plan_markers_.loan();
    *markers = draw_plans({.needle = needle_plan_.latest(),
                           .implant = implant_plan_.latest(),
                           .incision = incision_.latest(),
                           .way = way_ ? &*way_ : nullptr},
                          image_, tree_.name(kBaseFrame), now);
    markers.publish();
  }

  void publish_frames(const JointVector& q, Time stamp) {
    if (!tf_.has_subscribers()) return;
    auto frames = tf_.loan();
    tree_.write_moving(q, stamp, *frames);
    frames.publish();
  }

  void publish_joints(const msg::JointState& arm) {
    if (!joint_states_.has_subscribers()) return;
    auto joints = joint_states_.loan();
    *joints = arm;
    joints.publish();
  }

  void publish_tool_pose(const JointVector& q, Time stamp) {
    if (!tool_pose_.has_subscribers()) return;
    auto pose = tool_pose_.loan();
    write_header(pose->header_(), stamp, tree_.name(kBaseFrame));
    assign(pose->pose_(), forward_kinematics(model_, q));
    pose.publish();
  }

  void publish_markers(const JointVector& q, Time stamp) {
    if (!markers_.has_subscribers()) return;
    const msg::ToolPath* path = path_.latest();
    auto markers = markers_.loan();
    *markers = picture_.draw(q, stamp,
                             {.target = target_.latest(),
                              .truth = truth_.latest(),
                              .face = face_.latest(),
                              .path = path,
                              .path_is_followed = path && goals_.pursues(path->goal_id_())});
    markers.publish();
  }

  RobotModel model_;
  Parameters parameters_;
  FrameTree tree_;
  Picture picture_;
  GoalWatch goals_;
  RateLimiter rate_limiter_, marker_rate_limiter_;
  bool told_once_ = false;
  std::optional<Time> published_at_;
  Input<msg::JointState> measured_js_;
  Input<msg::Target> target_, truth_;
  Input<msg::FacePose> face_;
  Input<msg::ToolPath> path_;
  Input<msg::MotionStatus> motion_status_;
  Input<msg::NeedlePlan> needle_plan_;
  Input<msg::ImplantPlan> implant_plan_;
  OverheardRegistration registration_;
  Input<msg::TFMessage> chain_;
  Input<msg::PointStamped> incision_;
  Input<msg::MotionGoal> goal_;
  ImageInBase image_;
  std::optional<msg::MotionGoal> way_;
  Output<msg::TFMessage> tf_, tf_static_;
  Output<msg::JointState> joint_states_;
  Output<msg::PoseStamped> tool_pose_;
  Output<msg::MarkerArray> markers_, plan_markers_;
  Output<msg::String> robot_description_;
};

}  // namespace armature::monitor::rviz

ARMATURE_PLUGIN(armature::monitor::rviz::RvizMonitor);
