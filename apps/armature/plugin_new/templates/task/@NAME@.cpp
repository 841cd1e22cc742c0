#include "@TARGET@_parameters.hpp"  // made from plugin.yaml
#include "@TARGET@_ports.hpp"
#include "armature/kinds/geometry_params.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/motion/goal_messages.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/task/pursued_goal.hpp"

namespace @NAMESPACE@ {
/// There and back. What a goal needs besides (its number, another try) PursuedGoal knows.
class @CLASS@ final : public Component {
 public:
  explicit @CLASS@(Setup& setup) : Component{setup}, ports_{setup} {
    const RobotModel robot = robot_of(setup);
    const Eigen::Isometry3d home = forward_kinematics(robot, resting_position(robot));
    poses_[1] = {home.translation(), Eigen::Quaterniond{home.linear()}};
    // A robot with a pointing axis is told where that shall point, one without the whole rotation.
    if (const auto& axis = robot.pointing_axis())
      poses_[1].orientation = Direction{home.linear() * *axis};
    poses_[0] = {home.translation() + vector_of(Parameters::read(setup.params()).away),
                 poses_[1].orientation};
    pursued_.set(goal_at(poses_[0]));
    setup.activate_every(seconds(0.01));
  }

  void step(Time now) override {
    if (!start_) return void(start_ = now);  // first the arm tells where it is
    for (std::size_t i = 0; i < ports_.motion_status.size(); ++i)
      pursued_.hear(report_of(ports_.motion_status[i]), now);
    if (pursued_.state() == PursuedGoal::State::done && !done_s_) {
      if (++reached_ < poses_.size()) {
        pursued_.set(goal_at(poses_[reached_]));
      } else {
        done_s_ = to_seconds(now - *start_);
      }
      log("pose " + std::to_string(reached_) + " of " + std::to_string(poses_.size()) + " reached");
    }
    if (const auto goal = pursued_.outgoing(now)) {
      auto message = ports_.goal.loan();
      write_goal(*goal, now, *message);
      message.publish();
    }
  }

  /// The run ends then.
  bool finished() const override {
    return done_s_ || pursued_.state() == PursuedGoal::State::failed;
  }
  void summarize(Summary& summary) const override {
    if (done_s_) summary.metric("time_to_done_s", "time until the tool is back [s]", *done_s_);
    if (pursued_.state() == PursuedGoal::State::failed)
      summary.failed("refused", pursued_.reason());
  }

 private:
  static MotionGoal goal_at(const ToolPose& pose) {
    MotionGoal goal;  // planned: along a path, to rest
    goal.pose = pose;
    return goal;
  }

  Ports ports_;
  std::array<ToolPose, 2> poses_;
  std::size_t reached_ = 0;
  PursuedGoal pursued_;
  std::optional<Time> start_;
  std::optional<double> done_s_;
};
}  // namespace @NAMESPACE@
ARMATURE_PLUGIN(@NAMESPACE@::@CLASS@);
