// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <utility>

#include "armature/kinds/geometry_params.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/registered_plan.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/motion/goal.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/execution/rate_limiter.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "frame_tree.hpp"
#include "image_in_base.hpp"
#include "monitor_rviz_ports.hpp"
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
        ports_{setup},
        needle_{ports_.needle_plan, ports_.request, ports_.registration},
        implant_{ports_.implant_plan, ports_.request, ports_.registration} {
    setup.activate_every(seconds(1 / parameters_.rate));
  }

  void step(Time now) override {
    for (std::size_t i = 0; i < ports_.motion_status.size(); ++i) {
      goals_.see(ports_.motion_status[i]);
    }
    publish_what_never_changes(now);
    if (hear_plans()) publish_plans(now);
    if (!rate_limiter_.due(now)) return;
    const msg::JointState* arm = ports_.measured_js.latest();
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
    auto fixed = ports_.tf_static.loan();
    tree_.write_fixed(now, *fixed);
    fixed.publish();
    auto description = ports_.robot_description.loan();
    description->data_(urdf_text(model_, tree_));
    description.publish();
  }

  /// True when something is known that was not before.
  bool hear_plans() {
    bool is_news =
        ports_.needle_plan.fresh() || ports_.implant_plan.fresh() || ports_.incision.fresh();
    is_news = hear_registration(needle_) || is_news;
    is_news = hear_registration(implant_) || is_news;
    if (ports_.chain.fresh()) image_.hear(*ports_.chain.latest());
    return hear_goals() || is_news || ports_.chain.fresh();
  }

  template <class Plan>
  bool hear_registration(RegisteredPlan<Plan>& plan) {
    const auto news = plan.read();
    if (news.registration && plan.registration()) image_.hear(*plan.registration());
    if (news.registration && !plan.registration()) image_.forget_registration();
    return news.plan || news.registration;
  }

  /// True when the arm is on another way: a pause, going on and going back are the same one.
  bool hear_goals() {
    bool is_news = false;
    for (std::size_t i = 0; i < ports_.goal.size(); ++i) {
      switch (static_cast<MotionMode>(ports_.goal[i].mode_())) {
        case MotionMode::planned:
          way_ = ports_.goal[i];
          is_news = true;
          break;
        case MotionMode::pause:
        case MotionMode::resume:
        case MotionMode::retrace: break;
        default: is_news = std::exchange(way_, std::nullopt).has_value() || is_news;
      }
    }
    return is_news;
  }

  /// Once for each change: DDS keeps the last array for those who come later.
  void publish_plans(Time now) {
    auto markers = ports_.plan_markers.loan();
    *markers = draw_plans({.needle = needle_.plan(),
                           .implant = implant_.plan(),
                           .incision = ports_.incision.latest(),
                           .way = way_ ? &*way_ : nullptr},
                          image_, tree_.name(kBaseFrame), now);
    markers.publish();
  }

  void publish_frames(const JointVector& q, Time stamp) {
    if (!ports_.tf.has_subscribers()) return;
    auto frames = ports_.tf.loan();
    tree_.write_moving(q, stamp, *frames);
    frames.publish();
  }

  void publish_joints(const msg::JointState& arm) {
    if (!ports_.joint_states.has_subscribers()) return;
    auto joints = ports_.joint_states.loan();
    *joints = arm;
    joints.publish();
  }

  void publish_tool_pose(const JointVector& q, Time stamp) {
    if (!ports_.tool_pose.has_subscribers()) return;
    auto pose = ports_.tool_pose.loan();
    write_header(pose->header_(), stamp, tree_.name(kBaseFrame));
    assign(pose->pose_(), forward_kinematics(model_, q));
    pose.publish();
  }

  void publish_markers(const JointVector& q, Time stamp) {
    if (!ports_.markers.has_subscribers()) return;
    const msg::ToolPath* path = ports_.path.latest();
    auto markers = ports_.markers.loan();
    *markers = picture_.draw(q, stamp,
                             {.target = ports_.target.latest(),
                              .truth = ports_.truth.latest(),
                              .face = ports_.face.latest(),
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
  Ports ports_;
  RegisteredPlan<msg::NeedlePlan> needle_;
  RegisteredPlan<msg::ImplantPlan> implant_;
  ImageInBase image_;
  std::optional<msg::MotionGoal> way_;
};

}  // namespace armature::monitor::rviz

ARMATURE_PLUGIN(armature::monitor::rviz::RvizMonitor);
