// SPDX-License-Identifier: Apache-2.0
#include "key_poses.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace armature::path::orientations {
namespace {

// [m] and [rad]: two poses are one. Keys as near as where an arm stands and where it should stand
// would make a corner as short.
constexpr double kSame = 1e-6;
// [rad] and [m] in all: below, a turn or a way is rather the rounding of where the arm stands, and
// loses its weight in the parameters.
constexpr double kLittleTurn = 0.01, kLittleWay = 0.001;
constexpr double kOpposite = 1e-9;

double angle(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Eigen::Quaterniond a_R_b = a.conjugate() * b;
  return 2 * std::atan2(a_R_b.vec().norm(), std::abs(a_R_b.w()));
}

/// Any rotation that takes x to `unit`.
Eigen::Quaterniond pointing_along(const Eigen::Vector3d& unit) {
  Eigen::Matrix3d R;
  R.col(0) = unit;
  R.col(1) = unit.unitOrthogonal();
  R.col(2) = unit.cross(R.col(1));
  return Eigen::Quaterniond{R};
}

/// The smallest turn from one unit vector to another that is not opposite.
Eigen::Quaterniond smallest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Eigen::Quaterniond turn;
  turn.w() = 1 + from.dot(to);
  turn.vec() = from.cross(to);
  return turn.normalized();
}

/// The rotation of the next pose, after those that are there already.
Expected<Eigen::Quaterniond> next_rotation(const KeyPoses& keys, const Orientation& orientation) {
  if (!keys.pointing) return std::get<Eigen::Quaterniond>(orientation);
  const Eigen::Vector3d& to = std::get<Direction>(orientation).unit;
  if (keys.poses.empty()) return pointing_along(to);
  const Eigen::Vector3d& from = std::get<Direction>(keys.poses.back().orientation).unit;
  if ((from + to).norm() < kOpposite) {
    return refuse("a direction is opposite to the one before: antipodal, any way is as short");
  }
  return smallest_turn(from, to) * keys.rotations.back();
}

bool repeats_last(const KeyPoses& keys, const ToolPose& pose, const Eigen::Quaterniond& rotation) {
  return !keys.poses.empty() && (keys.positions.back() - pose.position).norm() <= kSame &&
         angle(keys.rotations.back(), rotation) <= kSame;
}

}  // namespace

Orientation KeyPoses::told(const Eigen::Quaterniond& rotation) const {
  if (!pointing) return rotation;
  return Direction{rotation * Eigen::Vector3d::UnitX()};
}

void KeyPoses::add(const ToolPose& pose, const Eigen::Quaterniond& rotation) {
  poses.push_back(pose);
  positions.push_back(pose.position);
  rotations.push_back(rotation);
}

void KeyPoses::remove_last() {
  poses.pop_back();
  positions.pop_back();
  rotations.pop_back();
}

Expected<KeyPoses> key_poses_of(const PathRequest& request) {
  std::vector<ToolPose> all{request.start};
  all.insert(all.end(), request.through.begin(), request.through.end());
  all.push_back(request.goal);
  KeyPoses keys;
  keys.pointing = std::holds_alternative<Direction>(request.start.orientation);
  for (const ToolPose& pose : all) {
    if (std::holds_alternative<Direction>(pose.orientation) != keys.pointing) {
      return refuse("start, key poses and goal must all have a rotation, or all a direction");
    }
    const auto rotation = next_rotation(keys, pose.orientation);
    if (!rotation) return tl::unexpected{rotation.error()};
    if (repeats_last(keys, pose, *rotation)) {
      const bool is_goal = &pose == &all.back(), only_start = keys.poses.size() == 1;
      if (!is_goal || only_start) continue;
      keys.remove_last();
    }
    keys.add(pose, *rotation);
  }
  return keys;
}

std::vector<double> key_parameters(const KeyPoses& keys) {
  std::vector<double> turns, ways;
  for (std::size_t i = 1; i < keys.poses.size(); ++i) {
    turns.push_back(angle(keys.rotations[i - 1], keys.rotations[i]));
    ways.push_back((keys.positions[i] - keys.positions[i - 1]).norm());
  }
  const double turn = std::max(kLittleTurn, std::accumulate(turns.begin(), turns.end(), 0.0));
  const double way = std::max(kLittleWay, std::accumulate(ways.begin(), ways.end(), 0.0));
  std::vector<double> u{0};
  for (std::size_t i = 0; i < turns.size(); ++i) {
    u.push_back(u.back() + turns[i] / turn + ways[i] / way);
  }
  const double all = u.back();
  for (double& each : u) each /= all;
  return u;
}

}  // namespace armature::path::orientations
