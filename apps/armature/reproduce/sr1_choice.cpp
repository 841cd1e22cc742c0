// SPDX-License-Identifier: Apache-2.0
// SR-1, the choice of a branch over the whole path: min-max against nearest, with the limits of the
// joints and without.
#include <Eigen/SVD>
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "armature/robot/kinematics/joint_inertia.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "reproduce/results.hpp"
#include "reproduce/sr1_arm.hpp"
#include "reproduce/sr1_parts.hpp"

namespace armature::reproduce::sr1 {
namespace {

constexpr int kWaypoints = 81;
constexpr double kDuration_s = 8, kStep_s = kDuration_s / (kWaypoints - 1);
constexpr double kStandOff_m = 0.05;  // before the entry

/// From home to the stand-off point and on to the target, uniform in length.
std::vector<Eigen::Isometry3d> planned_path(const Numbers& plan) {
  const Eigen::Vector3d home = plan["home_m"].numbers(), entry = plan["entry_m"].numbers();
  const Eigen::Vector3d target = plan["target_m"].numbers();
  const Eigen::Vector3d stand_off = entry - kStandOff_m * (target - entry).normalized();
  const double first = (stand_off - home).norm(), second = (target - stand_off).norm();
  std::vector<Eigen::Isometry3d> path;
  for (int k = 0; k < kWaypoints; ++k) {
    const double s = (first + second) * k / (kWaypoints - 1);
    Eigen::Isometry3d& pose = path.emplace_back(Eigen::Isometry3d::Identity());
    pose.linear() = rotation_of(plan["R"]);
    pose.translation() = s <= first ? home + (stand_off - home) * (s / first)
                                    : stand_off + (target - stand_off) * ((s - first) / second);
  }
  return path;
}

std::vector<IkBranches> branches_of(Arm& arm, const std::vector<Eigen::Isometry3d>& path) {
  std::vector<IkBranches> waypoints;
  for (const Eigen::Isometry3d& pose : path) waypoints.push_back(arm.branches(pose));
  return waypoints;
}

/// One branch from the first to the last waypoint, by its place, without whole turns.
std::vector<JointVector> followed(const std::vector<IkBranches>& waypoints, std::size_t branch) {
  std::vector<JointVector> joints{waypoints.front().branch[branch].q};
  for (std::size_t k = 1; k < waypoints.size(); ++k) {
    JointVector q = waypoints[k].branch[branch].q;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      q[i] = joints.back()[i] + wrap_angle(q[i] - joints.back()[i]);
    }
    joints.push_back(q);
  }
  return joints;
}

/// The greatest share of a joint's highest speed at every waypoint, by central differences,
/// one-sided at the ends.
std::vector<double> speed_ratios(const RobotModel& model, const std::vector<JointVector>& joints) {
  std::vector<double> ratios;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const std::size_t from = k == 0 ? 0 : k - 1, to = std::min(k + 1, joints.size() - 1);
    const JointVector way = (joints[to] - joints[from]).cwiseAbs();
    ratios.push_back(way.cwiseQuotient(model.max_velocity()).maxCoeff() /
                     (static_cast<double>(to - from) * kStep_s));
  }
  return ratios;
}

double greatest(const std::vector<double>& values) { return std::ranges::max(values); }

/// The greatest share of a joint's highest speed between two waypoints.
double greatest_step(const RobotModel& model, const std::vector<JointVector>& joints) {
  double step = 0;
  for (std::size_t k = 1; k < joints.size(); ++k) {
    const JointVector way = (joints[k] - joints[k - 1]).cwiseAbs();
    step = worst(step, way.cwiseQuotient(model.max_velocity()).maxCoeff() / kStep_s);
  }
  return step;
}

/// The longest move between two waypoints, as the arm feels it [kg^1/2 m].
double heaviest_move(const RobotModel& model, const std::vector<JointVector>& joints) {
  double move = 0;
  for (std::size_t k = 1; k < joints.size(); ++k) {
    move = worst(move, felt_length(model, joints[k] - joints[k - 1], joints[k]));
  }
  return move;
}

/// How far the path stays from the singular sets.
struct Dexterity {
  double manipulability = std::numeric_limits<double>::infinity();
  double singular_value = std::numeric_limits<double>::infinity();
};
Dexterity min_dexterity(const RobotModel& model, const std::vector<JointVector>& joints) {
  Dexterity least;
  for (const JointVector& q : joints) {
    least.manipulability = std::min(least.manipulability, manipulability(model, q));
    const Eigen::MatrixXd jacobian =
        forward_kinematics_with_jacobian(model, q, model.tool()).jacobian;
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd{jacobian};
    least.singular_value = std::min(least.singular_value, svd.singularValues().minCoeff());
  }
  return least;
}

/// How many branches keep the limits at every waypoint.
int count_within_limits(const std::vector<IkBranches>& waypoints) {
  int count = 0;
  for (std::size_t branch = 0; branch < 8; ++branch) {
    count += std::ranges::all_of(waypoints, [&](const IkBranches& waypoint) {
      return waypoint.branch[branch].within_limits;
    });
  }
  return count;
}

}  // namespace

void add_choice(const Numbers& numbers, Results& results) {
  const std::vector<Eigen::Isometry3d> path = planned_path(numbers["plan"]);
  Arm limited{shipped_robot("sr1")}, free{without_limits()};
  const std::vector<IkBranches> waypoints = branches_of(limited, path);
  const std::vector<IkBranches> free_waypoints = branches_of(free, path);
  std::vector<double> time;
  for (int k = 0; k < kWaypoints; ++k) time.push_back(kStep_s * k);

  for (std::size_t branch = 0; branch < 8; ++branch) {
    const std::string label{waypoints.front().branch[branch].label};
    const std::vector<JointVector> joints = followed(waypoints, branch);
    const std::vector<double> ratios = speed_ratios(limited.model(), joints);
    const Dexterity least = min_dexterity(limited.model(), joints);
    results.value("branches_of_the_path", label + ": speed ratio", greatest(ratios));
    results.value("branches_of_the_path", label + ": manipulability", least.manipulability);
    results.value("branches_of_the_path", label + ": singular value", least.singular_value);
    // The other wrist moves alike.
    if (branch % 2 == 0) {
      results.curve("speed_ratios", 0, label.substr(0, label.rfind('/')), time, ratios);
    }
  }

  const std::vector<JointVector> minmax = limited.chosen_by_minmax(waypoints);
  const std::vector<JointVector> nearest = limited.chosen_by_nearest(waypoints);
  const std::vector<JointVector> free_minmax = free.chosen_by_minmax(free_waypoints);
  const std::vector<JointVector> free_nearest = free.chosen_by_nearest(free_waypoints);
  const auto ratios_of = [&](const std::vector<JointVector>& joints) {
    return speed_ratios(limited.model(), joints);
  };
  const std::string table = "branch_choice";
  results.value(table, "branches within limits", count_within_limits(waypoints));
  results.value(table, "min-max within limits", greatest(ratios_of(minmax)));
  results.value(table, "min-max within limits: greatest step",
                greatest_step(limited.model(), minmax));
  results.value(table, "nearest within limits", greatest(ratios_of(nearest)));
  results.value(table, "min-max without limits", greatest(ratios_of(free_minmax)));
  results.value(table, "nearest without limits", greatest(ratios_of(free_nearest)));
  const std::vector<JointVector> free_lightest = free.chosen_by_inertia(free_waypoints);
  results.value(table, "min-max by inertia without limits", greatest(ratios_of(free_lightest)));
  results.value(
      table, "heaviest move without limits, by inertia over nearest",
      heaviest_move(limited.model(), free_lightest) / heaviest_move(limited.model(), free_nearest));
  results.curve("speed_ratios", 0, "select/minmax within limits", time, ratios_of(minmax),
                Results::Look::dots);
  results.curve("speed_ratios", 0, "select/minmax without limits", time, ratios_of(free_minmax),
                Results::Look::dots);
}

}  // namespace armature::reproduce::sr1
