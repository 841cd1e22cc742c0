// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/pivot.hpp"

#include <algorithm>
#include <cmath>

#include "armature/robot/kinematics/kinematics.hpp"

namespace armature {
namespace {

constexpr int kLooksAtPiece = 8;         // at a piece
constexpr double kPivotRounding = 1e-9;  // [m]

}  // namespace

void Pivot::set_incision(const Eigen::Vector3d& point) {
  incision_ = point;
  centre_.point = point;
}

ReasonText Pivot::refusal(const JointVector& q) const {
  const Eigen::Isometry3d base_T_tool = forward_kinematics(model_, q);
  const double deviation = centre_.deviation(base_T_tool), depth = centre_.depth(base_T_tool);
  const Eigen::Vector3d& at = centre_.point;
  if (deviation > options_.max_offset) {
    return ReasonText::format(
        "the shaft passes the incision at ({:.4f}, {:.4f}, {:.4f}) m by {:.2f} mm, more than "
        "max_incision_offset_mm, {:g}: register the incision where the shaft is, or bring the "
        "shaft through it",
        at.x(), at.y(), at.z(), 1e3 * deviation, 1e3 * options_.max_offset);
  }
  if (depth > 0 && depth <= centre_.shaft.length) return {};
  return ReasonText::format(
      "the incision at ({:.4f}, {:.4f}, {:.4f}) m lies {:.1f} mm behind the tip, not on the {:.1f} "
      "mm of the shaft: register it there, or move the shaft",
      at.x(), at.y(), at.z(), 1e3 * depth, 1e3 * centre_.shaft.length);
}

ReasonText Pivot::depth_defect(const Eigen::Isometry3d& base_T_tool) const {
  const double depth = (base_T_tool.translation() - centre_.point).norm();
  if (depth < options_.min_depth) {
    return ReasonText::format("the tip would be {:.1f} mm from the incision, min_depth_mm is {:g}",
                              1e3 * depth, 1e3 * options_.min_depth);
  }
  if (depth <= centre_.shaft.length) return {};
  return ReasonText::format("the tip would be {:.1f} mm deep, the shaft is {:.1f} mm long",
                            1e3 * depth, 1e3 * centre_.shaft.length);
}

double Pivot::deviation(const JointVector& q) const {
  return centre_.deviation(forward_kinematics(model_, q));
}

double Pivot::allowed_deviation(const JointVector& from) const {
  // The highest of the looks at a smooth way is nearly its peak.
  constexpr double kNearly = 0.95;
  return std::max(kNearly * options_.max_deviation, deviation(from) + kPivotRounding);
}

ReasonText Pivot::defect(const TrajectoryView& way, double allowed) const {
  double farthest = 0;
  for (int piece = 0; piece < way.piece_count(); ++piece) {
    const auto k = static_cast<std::size_t>(piece);
    const double from = way.knots[k], lasts = way.knots[k + 1] - from;
    for (int i = 1; i <= kLooksAtPiece; ++i) {
      const JointState there = way.at(way.start + seconds(from + lasts * i / kLooksAtPiece));
      farthest = std::max(farthest, deviation(there.q));
    }
  }
  if (farthest <= allowed) return {};
  return ReasonText::format("the shaft would leave the incision by {:.3f} mm, {:.3f} are allowed",
                            1e3 * farthest, 1e3 * allowed);
}

double Pivot::share_of_way(const JointVector& from, const JointVector& to) const {
  double farthest = 0;
  for (const double part : {0.25, 0.5, 0.75}) {
    farthest = std::max(farthest, deviation(from + part * (to - from)));
  }
  // It grows with the square of the way.
  const double may = 0.5 * allowed_deviation(from);
  return farthest <= may ? 1 : std::sqrt(may / farthest);
}

}  // namespace armature
