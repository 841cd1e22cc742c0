// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "joint_plot.hpp"
#include "joint_table.hpp"
#include "report_joints_parameters.hpp"
#include "report_joints_ports.hpp"
#include "row_file.hpp"
#include "timeline.hpp"
#include "tool_goal.hpp"

namespace armature::report::joints {
namespace {

constexpr Duration kPeriod = seconds(0.02);
// A reference, and the speed of a target, are not trusted for longer after they were told.
constexpr Duration kReferenceHolds = seconds(0.1), kTargetHolds = seconds(1);

/// Rates of all joints from those of the independent ones.
JointVector expand_rates(const RobotModel& model, const JointVector& v) {
  JointVector all(static_cast<Eigen::Index>(model.joints().size()));
  for (Eigen::Index j = 0; j < all.size(); ++j) {
    const ChainLink& link = model.chain()[static_cast<std::size_t>(j)];
    all[j] = link.ratio * v[link.independent];
  }
  return all;
}

}  // namespace

/// A reference of the independent joints.
struct Reference {
  JointVector q, v;
};

/// What became of goals. An arm that is stopped refuses each of a stream of them.
struct Motion {
  bool has_failed = false;  // the last goal that was told about
  std::optional<std::uint64_t> failed_goal = {};

  bool has_dropped(std::uint64_t goal) const { return has_failed || failed_goal == goal; }
};

class JointsReport : public Component {
 public:
  explicit JointsReport(Setup& setup)
      : Component(setup),
        model_{robot_of(setup)},
        pointing_axis_{model_.pointing_axis().value_or(Eigen::Vector3d::UnitX())},
        parameters_{Parameters::read(setup.params())},
        row_period_{seconds(1 / parameters_.rate)},
        plot_{model_},
        ports_{setup} {
    if (parameters_.file.empty()) return;
    remove_older(parameters_.file + ".svg");
    table_.emplace(parameters_.file + ".csv");
    table_->append(header_line(model_));
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    if (!table_) return;
    if (!start_) start_ = now;
    hear();
    lines_.clear();
    for (std::size_t i = 0; i < ports_.measured_js.size(); ++i) see(ports_.measured_js[i]);
    table_->append(lines_);
    tell_health();
  }

  /// From here on nobody goes to a goal any more, though some are still told.
  void begin_stop(Time now) override { stops_at_ = now; }

  void write_files(const std::filesystem::path&) const override {
    if (!table_) return;
    write_atomically(parameters_.file + ".svg", plot_.svg());
    table_->sync();
    if (!table_->trouble().empty()) throw std::runtime_error{table_->trouble()};
  }

 private:
  void hear() {
    for (std::size_t i = 0; i < ports_.servo_jp.size(); ++i) {
      Reference reference;
      const bool readable = read_joints(model_, ports_.servo_jp[i], reference.q).empty() &&
                            read_joint_rates(model_, ports_.servo_jp[i], reference.v).empty();
      if (readable) references_.add(stamp_of(ports_.servo_jp[i].header_().stamp_()), reference);
    }
    for (std::size_t i = 0; i < ports_.goal.size(); ++i) {
      const ToolGoal goal = tool_goal_of(ports_.goal[i], way_to_);
      if (goal.pose) way_to_ = goal.pose;
      goals_.add(stamp_of(ports_.goal[i].header_().stamp_()), goal);
    }
    for (std::size_t i = 0; i < ports_.status.size(); ++i) {
      constexpr std::uint8_t kFailed = 4;
      motion_.has_failed = ports_.status[i].state_() == kFailed;
      if (motion_.has_failed) motion_.failed_goal = ports_.status[i].goal_id_();
      motions_.add(stamp_of(ports_.status[i].header_().stamp_()), motion_);
    }
  }

  void see(const msg::JointState& measured) {
    const Time stamp = stamp_of(measured.header_().stamp_());
    if (stamp < *start_ || stamp < next_row_) return;
    JointVector q, v;
    unreadable_ = read_joints(model_, measured, q);
    if (!unreadable_.empty()) return;
    next_row_ = Time{(stamp.ns / row_period_.count() + 1) * row_period_.count()};
    JointRow row{.stamp = stamp,
                 .since_start = stamp - *start_,
                 .position = model_.to_all(q),
                 .speed = {},
                 .reference = reference_at(stamp)};
    if (read_joint_rates(model_, measured, v).empty()) row.speed = expand_rates(model_, v);
    row.goal = goal_error(q, stamp);
    append_line(row, lines_);
    plot_.add(row);
  }

  /// Of all joints, for the very instant at which the arm was measured.
  JointVector reference_at(Time stamp) {
    const auto* told = references_.at(stamp);
    if (!told || stamp - told->stamp > kReferenceHolds) return {};
    const double age_s = to_seconds(stamp - told->stamp);
    return model_.to_all(told->value.q + age_s * told->value.v);
  }

  std::optional<JointRow::Goal> goal_error(const JointVector& q, Time stamp) {
    const auto* told = goals_.at(stamp);
    if (!told || !told->value.pose || (stops_at_ && stamp > *stops_at_)) return std::nullopt;
    const auto* motion = motions_.at(stamp);
    if (motion && motion->value.has_dropped(told->value.id)) return std::nullopt;
    const double age_s = to_seconds(std::min(stamp - told->stamp, kTargetHolds));
    const PoseResidual error =
        residual(forward_kinematics(model_, q), pointing_axis_, told->value.after(age_s));
    return JointRow::Goal{told->value.id, error.position_m, error.angle_rad};
  }

  void tell_health() {
    if (!table_->trouble().empty()) return degraded(table_->trouble() + "; the arm goes on");
    if (!unreadable_.empty()) return degraded("measured_js: " + std::string{unreadable_.view()});
    healthy();
  }

  RobotModel model_;
  Eigen::Vector3d pointing_axis_;
  Parameters parameters_;
  Duration row_period_;
  mutable std::optional<RowFile> table_;  // also to be told, at the end, that the disk has it
  std::optional<Time> start_, stops_at_;
  Time next_row_;
  std::string lines_;  // of one step
  ReasonText unreadable_;
  Timeline<Reference> references_;
  Timeline<ToolGoal> goals_;
  std::optional<ToolPose> way_to_;  // where the way leads that is gone along
  Motion motion_;                   // as it was told last
  Timeline<Motion> motions_;
  JointPlot plot_;
  Ports ports_;
};

}  // namespace armature::report::joints

ARMATURE_PLUGIN(armature::report::joints::JointsReport);
