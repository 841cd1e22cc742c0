// SPDX-License-Identifier: Apache-2.0
// The chronicle has a line per thing, in the order in which they were seen, times in s:
//   ref TIME q... v... a...         of the independent joints, while they change
//   arm TIME q...                   the same, as measured
//   goal TIME id mode max_speed stepwise what; behind it of a planned one, key poses first:
//   pose id pointing x y z, and direction x y z 0 or quaternion x y z w
//   zone id name from x y z to x y z radius tool_enters
//   status TIME id state stage|reason    each change
//   stop TIME; rearm TIME
//   last TIME id                    the goal at the place where the arm stands
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/motion/goal_messages.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/chance.hpp"
#include "test_any_goal_parameters.hpp"
#include "test_any_goal_ports.hpp"

namespace armature::test::any_goal {
namespace {

using Eigen::Vector3d;

constexpr Duration kPeriod = seconds(0.001);

/// Lines of one kind: the first and the last of those that are equal but for their times.
class Rows {
 public:
  explicit Rows(const char* kind) : kind_{kind} {}

  void write(double time, std::string row, std::ofstream& chronicle) {
    const bool same = row == row_;
    if (!same && held_back_) put(*held_back_, row_, chronicle);
    held_back_.reset();
    if (same) {
      held_back_ = time;
      return;
    }
    put(time, row, chronicle);
    row_ = std::move(row);
  }

 private:
  void put(double time, const std::string& row, std::ofstream& chronicle) const {
    chronicle << fmt::format("{} {:.6f} {}\n", kind_, time, row);
  }

  const char* kind_;
  std::string row_;
  std::optional<double> held_back_;
};

}  // namespace

class AnyGoal final : public Component {
 public:
  explicit AnyGoal(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        robot_{robot_of(setup)},
        ports_{setup},
        chance_{parameters_.seed},
        chronicle_{std::filesystem::path{parameters_.file}} {
    if (!chronicle_) throw SetupError("cannot write " + parameters_.file);
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    now_ = now;
    watch();
    if (q_.size() == 0) return;
    rearm();
    if (finished_at_ || !is_due()) return;
    if (given_ >= parameters_.goals) return give_last();
    if (happens(parameters_.stops)) {
      stopped_ = true;
      rearm_at_ = now_ + seconds(2 * share() * share());
      tell(ports_.stop, "stop");
    }
    give_any();
    waits_ = !stopped_ && !happens(parameters_.haste);
    const double longest_s[] = {0, 0.003, 0.03, 0.3, 2};
    due_ = now_ + seconds(waits_ ? 6 : longest_s[below(5)] * share());
    // A hand keeps the arm until something else is wanted, and a stopped arm refuses everything.
    if (in_hand_) due_ = std::min(due_, now_ + seconds(share()));
    if (stopped_) due_ = std::max(due_, now_ + seconds(0.3 * share()));
  }

  bool finished() const override { return finished_at_ && now_ > *finished_at_; }

 private:
  double share() { return chance_.share(); }
  bool happens(double probability) { return chance_.happens(probability); }
  std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(share() * static_cast<double>(count));
  }
  double about(double most) { return most * (2 * share() - 1); }
  Vector3d any_vector(double most) {
    return Vector3d{about(1), about(1), about(1)}.normalized() * most * share();
  }
  double time(Time at) const { return to_seconds(at - *start_); }

  void watch() {
    for (std::size_t i = 0; i < ports_.reference.size(); ++i) {
      const msg::JointReference& reference = ports_.reference[i];
      const auto &q = reference.position_(), &v = reference.velocity_();
      q_ = Eigen::Map<const Eigen::VectorXd>(q.data(), robot_.dof());
      rests_ = std::ranges::all_of(v, [](double each) { return std::abs(each) < 1e-12; });
      if (!rests_) moved_ = now_;
      reference_.write(time(stamp_of(reference.header_().stamp_())),
                       fmt::format("{:.17g} {:.17g} {:.17g}", fmt::join(q, " "), fmt::join(v, " "),
                                   fmt::join(reference.acceleration_(), " ")),
                       chronicle_);
    }
    for (std::size_t i = 0; i < ports_.measured_js.size(); ++i) {
      const auto q = joints_of(robot_, ports_.measured_js[i]);
      if (!q) continue;
      arm_.write(time(stamp_of(ports_.measured_js[i].header_().stamp_())),
                 fmt::format("{:.17g}", fmt::join(q->begin(), q->end(), " ")), chronicle_);
    }
    for (std::size_t i = 0; i < ports_.status.size(); ++i) see(ports_.status[i]);
  }

  void see(const msg::MotionStatus& status) {
    stopped_ = status.stage_() == kStopStage;
    const GoalReport report = report_of(status);
    if (report.goal_id == last_id_ && report.state >= GoalReport::State::done) over_ = true;
    std::string line = fmt::format("{} {} {}|{}", report.goal_id, static_cast<int>(report.state),
                                   report.stage, report.reason);
    if (line != line_) write("status {:.6f} {}", time(stamp_of(status.header_().stamp_())), line);
    line_ = std::move(line);
  }

  void rearm() {
    if (!stopped_ || now_ < rearm_at_) return;
    rearm_at_ = now_ + seconds(0.3);
    tell(ports_.rearm, "rearm");
  }

  /// The last one waits until the arm stands.
  bool is_due() const {
    if (given_ < parameters_.goals || lasts_ > 0)
      return waits_ ? over_ || now_ >= due_ : now_ >= due_;
    const bool stands = rests_ && now_ - moved_ > seconds(0.5);
    return !stopped_ && stands && (over_ || now_ - moved_ > seconds(2));
  }

  /// Twice: the first goal behind a stop between two goals fails, and one of which a solver knows
  /// other joints moves the arm there.
  void give_last() {
    if (lasts_ == 2) {
      finished_at_ = now_ + seconds(0.3);
      return;
    }
    ++lasts_;
    give({.id = ++last_id_, .pose = pose_at(q_, robot_.pointing_axis().has_value())}, "last");
    waits_ = true;
    due_ = now_ + seconds(10);
    write("last {:.6f} {}", time(now_), last_id_);
  }

  /// Where the joints take the tool.
  ToolPose pose_at(const JointVector& q, bool pointing) const {
    const Eigen::Isometry3d base_T_tool = forward_kinematics(robot_, q);
    const Vector3d axis = robot_.pointing_axis().value_or(Vector3d::UnitX());
    if (pointing) return {base_T_tool.translation(), Direction{base_T_tool.linear() * axis}};
    return {base_T_tool.translation(), Eigen::Quaterniond{base_T_tool.linear()}};
  }

  JointVector anywhere() {
    JointVector q = q_;
    for (int i = 0; i < robot_.dof(); ++i) {
      const bool ends = std::isfinite(robot_.lower()[i]) && std::isfinite(robot_.upper()[i]);
      q[i] = ends ? std::lerp(robot_.lower()[i], robot_.upper()[i], share()) : q_[i] + about(3);
    }
    return q;
  }

  /// No joint moves by more than `most` [rad], or a fifth of that [m].
  JointVector near(const JointVector& from, double most) {
    JointVector q = from;
    for (int i = 0; i < robot_.dof(); ++i) {
      q[i] += about(robot_.is_revolute(i) ? most : most / 5);
      q[i] = std::clamp(q[i], robot_.lower()[i], robot_.upper()[i]);
    }
    return q;
  }

  /// A joint on its limit, or beside it by a nanometre's worth.
  JointVector at_limit() {
    JointVector q = near(q_, 0.3);
    const auto i = static_cast<Eigen::Index>(below(static_cast<std::size_t>(robot_.dof())));
    const double limit = happens(0.5) ? robot_.lower()[i] : robot_.upper()[i];
    const double beside[] = {-1e-9, 0, 1e-9};
    if (std::isfinite(limit)) q[i] = limit + beside[below(3)];
    return q;
  }

  void give_any() {
    ++given_;
    MotionGoal goal{.id = ++last_id_};
    const double kind = share();
    using enum MotionMode;
    const MotionMode modes[] = {pause, resume, retrace, hold, tracking, guided};
    if (kind > 0.75) goal.mode = modes[below(6) == 5 ? 5 : below(5)];
    goal.stepwise = happens(0.1) && goal.mode != tracking;
    in_hand_ = goal.mode == guided;
    if (!has_pose(goal.mode)) return give(goal, "no pose");
    const bool pointing = robot_.pointing_axis() ? happens(0.6) : happens(0.1);
    const double most[] = {0.02, 0.1, 0.5};
    JointVector q = near(q_, most[below(3)]);
    goal.pose = pose_at(q, pointing);
    const char* what = "near";
    const double place = share();
    if (place < 0.1) {
      goal.pose = pose_at(q = anywhere(), pointing);
      what = "anywhere";
    } else if (place < 0.2) {
      const double beside_m[] = {0, 1e-9, 1e-7, 1e-5};
      goal.pose = pose_at(q = q_, pointing);
      goal.pose.position += any_vector(beside_m[below(4)]);
      what = "here";
    } else if (place < 0.3) {
      goal.pose = pose_at(q = at_limit(), pointing);
      what = "limit";
    } else if (place < 0.33) {
      goal.pose.position *= 20;
      what = "far";
    } else if (place < 0.5) {
      goal.pose = pose_at(q = q_, pointing);
      goal.pose.position += any_vector(0.2);
      what = "moved";
    }
    if (goal.mode == tracking) {
      if (happens(0.3)) goal.velocity = any_vector(0.1);
      return give(goal, what);
    }
    if (happens(0.15)) goal.max_speed = 0.03 + 0.3 * share();
    add_to(goal, q, pointing);
    give(goal, what);
  }

  /// Key poses, zones and the point to look at of a planned goal that is reached with `q`.
  void add_to(MotionGoal& goal, const JointVector& q, bool pointing) {
    if (parameters_.entries) {
      const auto* direction = std::get_if<Direction>(&goal.pose.orientation);
      const Vector3d along =
          direction ? direction->unit
                    : std::get<Eigen::Quaterniond>(goal.pose.orientation) * Vector3d::UnitZ();
      goal.focus = goal.pose.position - (0.08 * share() - 0.02) * along;
    } else if (happens(0.4)) {
      for (std::size_t keys = 1 + below(3); keys > 0; --keys) {
        goal.through.push_back(pose_at(near(q, 0.2), pointing));
      }
      if (happens(0.2)) goal.through.push_back(goal.through.back());
    }
    if (!parameters_.zones) return;
    for (std::size_t i = 1 + below(3); i > 0; --i) {
      const JointVector between = q_ + share() * (q - q_);
      const double beside_m[] = {0.02, 0.1, 0.5};
      const Vector3d from =
          forward_kinematics(robot_, between).translation() + any_vector(beside_m[below(3)]);
      const Vector3d to = happens(0.5) ? from : Vector3d{from + any_vector(0.3)};
      const double radius_m[] = {0, 0.01, 0.1};
      goal.forbidden.push_back({"zone" + std::to_string(i), from, to, radius_m[below(3)] * share(),
                                parameters_.entries && happens(0.5)});
    }
  }

  void give(const MotionGoal& goal, const char* what) {
    over_ = false;
    write("goal {:.6f} {} {} {:.17g} {} {}", time(now_), goal.id, static_cast<int>(goal.mode),
          goal.max_speed, goal.stepwise ? 1 : 0, what);
    if (goal.mode == MotionMode::planned) {
      for (const ToolPose& key : goal.through) write_pose(goal.id, key);
      write_pose(goal.id, goal.pose);
    }
    for (const ForbiddenZone& zone : goal.forbidden) {
      write("zone {} {} {:.17g} {:.17g} {:.17g} {}", goal.id, zone.name, fmt::join(zone.from, " "),
            fmt::join(zone.to, " "), zone.radius_m, zone.tool_enters ? 1 : 0);
    }
    auto loan = ports_.goal.loan();
    armature::write_goal(goal, now_, *loan);
    loan.publish();
  }

  void write_pose(std::uint64_t id, const ToolPose& pose) {
    const auto* direction = std::get_if<Direction>(&pose.orientation);
    Eigen::Vector4d turn = Eigen::Vector4d::Zero();
    if (direction) turn.head<3>() = direction->unit;
    if (!direction) turn = std::get<Eigen::Quaterniond>(pose.orientation).coeffs();
    write("pose {} {} {:.17g} {:.17g}", id, direction ? 1 : 0, fmt::join(pose.position, " "),
          fmt::join(turn, " "));
  }

  void tell(Output<msg::Bool>& output, const char* what) {
    write("{} {:.6f}", what, time(now_));
    auto loan = output.loan();
    loan->data_(true);
    loan.publish();
  }

  template <class... Values>
  void write(fmt::format_string<Values...> format, Values&&... values) {
    chronicle_ << fmt::format(format, std::forward<Values>(values)...) << '\n';
  }

  Parameters parameters_;
  RobotModel robot_;
  Ports ports_;
  Chance chance_;
  std::ofstream chronicle_;
  std::optional<Time> start_, finished_at_;
  Time now_, due_, rearm_at_, moved_;
  Rows reference_{"ref"}, arm_{"arm"};
  JointVector q_;  // of the reference
  bool rests_ = false, stopped_ = false;
  std::string line_;
  std::uint64_t last_id_ = 0, given_ = 0;
  int lasts_ = 0;  // goals where the arm stands
  bool over_ = true, waits_ = false, in_hand_ = false;
};

}  // namespace armature::test::any_goal

ARMATURE_PLUGIN(armature::test::any_goal::AnyGoal);
