// SPDX-License-Identifier: Apache-2.0
// SR-1, the needle's way from the entry to the target: with six joints that turn (6R), and with a
// needle as sixth joint (5R1P).
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/values/angles.hpp"
#include "reproduce/angles.hpp"
#include "reproduce/results.hpp"
#include "reproduce/sr1_arm.hpp"
#include "reproduce/sr1_parts.hpp"

namespace armature::reproduce::sr1 {
namespace {

using Eigen::Vector3d;

constexpr int kNeedle = 5;                 // the joint of 5R1P that does not turn
constexpr double kNeedleAtEntry_m = 0.15;  // as in configs/sr1_biopsy.yaml

struct Insertion {
  explicit Insertion(const Numbers& plan)
      : entry{plan["entry_m"].numbers()},
        target{plan["target_m"].numbers()},
        along{(target - entry).normalized()},
        R{rotation_of(plan["R"])} {}

  Vector3d entry, target, along;
  Eigen::Quaterniond R;  // of the tool, its z along the line
};

/// How the needle keeps to its line.
struct Track {
  std::vector<double> past_entry_mm, off_mm, tilt_deg;

  void add(const Insertion& plan, const Eigen::Isometry3d& base_T_tool) {
    const Vector3d from_entry = base_T_tool.translation() - plan.entry;
    past_entry_mm.push_back(1e3 * from_entry.dot(plan.along));
    off_mm.push_back(1e3 * from_entry.cross(plan.along).norm());
    tilt_deg.push_back(angle_between(base_T_tool.linear().col(2), plan.along) / kRadPerDegree);
  }
  double max_off_mm() const { return std::ranges::max(off_mm); }
  double max_tilt_deg() const { return std::ranges::max(tilt_deg); }
};

constexpr int kSamples = 200;

/// Straight in joint space from `from` to `to`.
Track interpolated(const Insertion& plan, const RobotModel& model, const JointVector& from,
                   const JointVector& to) {
  Track track;
  JointVector way = to - from;
  for (Eigen::Index i = 0; i < way.size(); ++i) {
    if (model.is_revolute(static_cast<int>(i))) way[i] = wrap_angle(way[i]);
  }
  for (int n = 0; n <= kSamples; ++n) {
    const JointVector q = from + way * n / kSamples;
    track.add(plan, forward_kinematics(model, q));
  }
  return track;
}

/// The insertion as configs/sr1_biopsy.yaml plans it: path/needle, ik/puma_algebraic,
/// select/minmax, trajectory/quintic_spline.
struct Planned {
  std::vector<JointVector> joints;       // at the samples of the path
  std::vector<IkBranches> at_waypoints;  // all branches there
  Track track;                           // of the motion
};

Planned planned(const Insertion& plan, Arm& arm, const Orientation& orientation,
                const std::string& path_params) {
  const Path path = arm.needle_path(
      {.start = {plan.entry, orientation}, .goal = {plan.target, orientation}, .focus = plan.entry},
      path_params);
  if (path.size() != 1) throw std::runtime_error("path/needle: not a line alone");
  Planned result;
  JointSegment segment;
  for (const PathSample& sample : path.front().samples) {
    const auto depth = sample.redundancy ? std::optional{sample.redundancy->value} : std::nullopt;
    segment.s.push_back(sample.s);
    result.at_waypoints.push_back(arm.branches(sample.pose, depth));
  }
  result.joints = segment.q = arm.chosen_by_minmax(result.at_waypoints);
  const Trajectory motion = arm.timed(segment);
  for (int n = 0; n <= kSamples; ++n) {
    const double t = motion.duration_s() * n / kSamples;
    result.track.add(plan, forward_kinematics(arm.model(), motion.at(motion.start + seconds(t)).q));
  }
  return result;
}

/// Joints that are elsewhere at the end of the insertion, or on the way.
int count_moving(const std::vector<JointVector>& joints) {
  constexpr double kStill = 1e-9;  // [rad] or [m]
  int count = 0;
  for (Eigen::Index i = 0; i < joints.front().size(); ++i) {
    count += std::ranges::any_of(
        joints, [&](const JointVector& q) { return std::abs(q[i] - joints.front()[i]) > kStill; });
  }
  return count;
}

/// The largest turn of any branch of any joint that turns, from the entry to a point of the path.
double largest_turn_of(const Planned& needle) {
  double largest = 0;
  for (const IkBranches& here : needle.at_waypoints) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(here.count); ++i) {
      largest = worst(largest, largest_turn(needle.at_waypoints.front().branch[i].q.head<kNeedle>(),
                                            here.branch[i].q.head<kNeedle>()));
    }
  }
  return largest;
}

void add_curves(const std::string& name, const Track& track, Results::Look look, Results& results) {
  results.curve("insertion", 0, name, track.past_entry_mm, track.off_mm, look);
  results.curve("insertion", 1, name, track.past_entry_mm, track.tilt_deg, look);
}

/// Every arm of 6R, straight in joint space; the other wrist moves alike.
void add_interpolated(const Insertion& plan, const RobotModel& model, const IkBranches& entry,
                      const IkBranches& target, Results& results) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(entry.count); i += 2) {
    const JointVector &from = entry.branch[i].q, &to = target.branch[i].q;
    const Track track = interpolated(plan, model, from, to);
    const std::string label{entry.branch[i].label};
    const std::string name = label.substr(0, label.rfind('/')) + ", joints interpolated";
    results.value("insertion_line", name + ": off the line", track.max_off_mm());
    results.value("insertion_line", name + ": tilt", track.max_tilt_deg());
    results.value("insertion_line", name + ": turn", largest_turn(from, to) / kRadPerDegree);
    add_curves("6R " + name, track, Results::Look::line, results);
  }
}

}  // namespace

void add_insertion(const Numbers& numbers, Results& results) {
  const Insertion plan{numbers["plan"]};
  Arm arm{shipped_robot("sr1")}, needle_arm{shipped_robot("sr1_needle")};
  const Planned ours = planned(plan, arm, plan.R, "");
  const Planned needle = planned(plan, needle_arm, Direction{plan.along},
                                 "needle_at_entry_m: " + std::to_string(kNeedleAtEntry_m));
  const Track joints = interpolated(plan, arm.model(), ours.joints.front(), ours.joints.back());
  const Track needle_joints =
      interpolated(plan, needle_arm.model(), needle.joints.front(), needle.joints.back());

  const std::string line = "insertion_line";
  add_interpolated(plan, arm.model(), ours.at_waypoints.front(), ours.at_waypoints.back(), results);
  results.value(line, "6R, path/needle: off the line", ours.track.max_off_mm());
  results.value(line, "6R, path/needle: tilt", ours.track.max_tilt_deg());
  results.value(line, "5R1P, path/needle: off the line", needle.track.max_off_mm());
  results.value(line, "5R1P, path/needle: tilt", needle.track.max_tilt_deg());
  add_curves("6R, path/needle", ours.track, Results::Look::line, results);
  add_curves("5R1P, path/needle", needle.track, Results::Look::dashed, results);

  const std::string modes = "table_5_1";
  results.value(modes, "6R: branches", ours.at_waypoints.front().count);
  results.value(modes, "6R: joints that move", count_moving(ours.joints));
  results.value(modes, "6R: off the line when interpolated", joints.max_off_mm());
  results.value(modes, "5R1P: branches", needle.at_waypoints.front().count);
  results.value(modes, "5R1P: joints that move", count_moving(needle.joints));
  results.value(modes, "5R1P: off the line when interpolated", needle_joints.max_off_mm());
  results.value(modes, "5R1P: turn of joints 1 to 5", largest_turn_of(needle));
  results.value(modes, "5R1P: way of the needle",
                1e3 * (needle.joints.back()[kNeedle] - needle.joints.front()[kNeedle]));
}

}  // namespace armature::reproduce::sr1
