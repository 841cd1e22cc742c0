// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/link_clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Added to every step, so that steps end. Between two instants a link can have been nearer by half
/// of it.
constexpr double kResolution_m = 1e-4;

/// A capsule's middle line at one posture.
struct Line {
  Eigen::Vector3d from, to;
};

/// The frames of all joints at one posture.
class Posture {
 public:
  Posture(const RobotModel& model, const JointVector& q) {
    joint_frames(model, q, std::span{frames_}.first(static_cast<std::size_t>(model.joint_count())));
  }
  Line line(const LinkCapsule& capsule) const {
    if (capsule.parent_joint < 0) return {capsule.from, capsule.to};
    const auto& base_T_joint = frames_[static_cast<std::size_t>(capsule.parent_joint)];
    return {base_T_joint * capsule.from, base_T_joint * capsule.to};
  }

 private:
  std::array<Eigen::Isometry3d, kMaxJoints> frames_;
};

/// The nearest zone of one capsule; of one that `may_enter` only those that no tool enters.
LinkClearance nearest_zone(const Posture& posture, const LinkCapsule& capsule, std::size_t index,
                           std::span<const ForbiddenZone> zones, bool may_enter = false) {
  LinkClearance least{.capsule = index, .zone = 0, .distance_m = kInfinity};
  const Line line = posture.line(capsule);
  for (std::size_t z = 0; z < zones.size(); ++z) {
    if (may_enter && zones[z].tool_enters) continue;
    const double distance = clearance(line.from, line.to, zones[z]) - capsule.radius;
    // NaN is nearer than anything.
    if (std::isnan(distance) || distance < least.distance_m) least = {index, z, distance};
  }
  return least;
}

/// The longest that the row of a joint can be [m].
double length_of(const ChainLink& link, const RobotModel& model) {
  double d = std::abs(link.d);
  if (link.prismatic && link.ratio == 0) {
    d += std::abs(link.offset);
  } else if (link.prismatic) {
    const double low = link.ratio * model.lower()[link.independent] + link.offset;
    const double high = link.ratio * model.upper()[link.independent] + link.offset;
    d += std::max(std::abs(low), std::abs(high));
  }
  return link.placement.translation().norm() + std::abs(link.a) + d;
}

/// How far any point of a capsule's line moves at most for 1 rad or 1 m of each independent joint.
JointVector reach_of(const LinkCapsule& capsule, const RobotModel& model) {
  JointVector reach = JointVector::Zero(model.dof());
  double arm = std::max(capsule.from.norm(), capsule.to.norm());
  for (int i = capsule.parent_joint; i >= 0; --i) {
    const ChainLink& link = model.chain()[static_cast<std::size_t>(i)];
    arm += length_of(link, model);
    reach[link.independent] += std::abs(link.ratio) * (link.prismatic ? 1 : arm);
  }
  return reach;
}

/// Of any point of a capsule [m/s]. A joint that stands still adds nothing, however far it reaches.
double greatest_speed(const JointVector& reach, const JointVector& joint_speeds) {
  double speed = 0;
  for (int i = 0; i < reach.size(); ++i) {
    if (joint_speeds[i] > 0) speed += reach[i] * joint_speeds[i];
  }
  return speed;
}

JointVector greatest_speeds(const TrajectoryView& trajectory, int piece) {
  const auto k = static_cast<std::size_t>(piece);
  const double duration = trajectory.knots[k + 1] - trajectory.knots[k];
  JointVector speeds(trajectory.dof);
  for (int joint = 0; joint < trajectory.dof; ++joint) {
    speeds[joint] = peaks(trajectory.piece(piece, joint), duration).velocity;
  }
  return speeds;
}

}  // namespace

std::optional<LinkClearance> link_clearance(const RobotModel& model, const JointVector& q,
                                            std::span<const ForbiddenZone> zones) {
  if (model.capsules().empty() || zones.empty()) return std::nullopt;
  const Posture posture{model, q};
  LinkClearance least{.distance_m = kInfinity};
  for (std::size_t c = 0; c < model.capsules().size(); ++c) {
    const LinkClearance found = nearest_zone(posture, model.capsules()[c], c, zones);
    if (std::isnan(found.distance_m) || found.distance_m < least.distance_m) least = found;
  }
  return least;
}

std::optional<LinkViolation> first_violation(const RobotModel& model,
                                             const TrajectoryView& trajectory,
                                             std::span<const ForbiddenZone> zones,
                                             double min_distance_m, double tool_enters_s) {
  constexpr double kShortestStep_s = 1e-5;
  if (zones.empty()) return std::nullopt;
  const int carrier = model.frame(model.tool()).parent_joint;
  std::vector<JointVector> reach;
  for (const LinkCapsule& capsule : model.capsules()) reach.push_back(reach_of(capsule, model));
  for (int piece = 0; piece < trajectory.piece_count(); ++piece) {
    const double end = trajectory.knots[static_cast<std::size_t>(piece) + 1];
    const JointVector speeds = greatest_speeds(trajectory, piece);
    for (double t = trajectory.knots[static_cast<std::size_t>(piece)]; t <= end;) {
      const Posture posture{model, state_at(trajectory, t).q};
      double step = kInfinity;
      std::optional<LinkClearance> too_near;
      for (std::size_t c = 0; c < reach.size(); ++c) {
        const LinkCapsule& capsule = model.capsules()[c];
        const bool may_enter = t >= tool_enters_s && capsule.parent_joint == carrier;
        const LinkClearance near = nearest_zone(posture, capsule, c, zones, may_enter);
        const double room = near.distance_m - min_distance_m;
        const bool nearest = !too_near || near.distance_m < too_near->distance_m;
        if (!(room >= 0) && nearest) too_near = near;
        step = std::min(step, (room + kResolution_m) / greatest_speed(reach[c], speeds));
      }
      if (too_near) return LinkViolation{*too_near, t};
      if (t == end) break;
      t = std::min(t + std::max(step, kShortestStep_s), end);
    }
  }
  return std::nullopt;
}

}  // namespace armature
