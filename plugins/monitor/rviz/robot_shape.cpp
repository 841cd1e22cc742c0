// SPDX-License-Identifier: Apache-2.0
#include "robot_shape.hpp"

#include <cmath>

namespace armature::monitor::rviz {
namespace {

using Eigen::Vector3d;

constexpr double kNoLength = 1e-9;  // [m]

/// Where one joint's lines and axis are, and in which frames (joint indices).
struct JointLines {
  Segment along_d, along_a;
  int frame_of_d, frame_of_a;
  Vector3d middle, axis;  // of the joint, in front of its row
};

/// T = Rz(theta) Tz(d) Tx(a) Rx(alpha): both lines are fixed to the frame behind the joint.
JointLines standard_lines(int joint, const ChainLink& link, double d) {
  const Vector3d corner{-link.a, 0, 0};
  const Vector3d axis{0, link.sin_alpha, link.cos_alpha};  // Rx(-alpha) z
  return {.along_d = {corner - d * axis, corner},
          .along_a = {corner, Vector3d::Zero()},
          .frame_of_d = joint,
          .frame_of_a = joint,
          .middle = Vector3d::Zero(),
          .axis = Vector3d::UnitZ()};
}

/// T = Rx(alpha) Tx(a) Rz(theta) Tz(d): a is fixed to the frame before the joint, d behind it.
JointLines modified_lines(int joint, const ChainLink& link, double d) {
  return {.along_d = {{0, 0, -d}, Vector3d::Zero()},
          .along_a = {Vector3d::Zero(), {link.a, 0, 0}},
          .frame_of_d = joint,
          .frame_of_a = joint - 1,
          .middle = {link.a, 0, 0},
          .axis = {0, -link.sin_alpha, link.cos_alpha}};  // Rx(alpha) z
}

}  // namespace

std::vector<RobotPart> robot_shape(const RobotModel& model, const JointVector& q) {
  std::vector<RobotPart> parts;
  for (int i = 0; i < model.joint_count(); ++i) {
    const ChainLink& link = model.chain()[static_cast<std::size_t>(i)];
    const double value = link.ratio * q[link.independent] + link.offset;
    const double d = link.prismatic ? link.d + value : link.d;
    const JointLines lines = model.convention() == RobotModel::Convention::standard
                                 ? standard_lines(i, link, d)
                                 : modified_lines(i, link, d);
    const auto in_frame_before = [&](const Segment& s) -> Segment {
      return {link.placement * s.from, link.placement * s.to};
    };
    if (link.placement.translation().norm() > kNoLength) {
      parts.push_back({4 * i + 3,
                       RobotPart::Kind::link,
                       i - 1,
                       {Vector3d::Zero(), link.placement.translation()}});
    }
    if (link.prismatic || std::abs(d) > kNoLength) {
      parts.push_back({4 * i, RobotPart::Kind::link, lines.frame_of_d, lines.along_d});
    }
    if (std::abs(link.a) > kNoLength) {
      const bool before = lines.frame_of_a < i;
      parts.push_back({4 * i + 1, RobotPart::Kind::link, lines.frame_of_a,
                       before ? in_frame_before(lines.along_a) : lines.along_a});
    }
    parts.push_back(
        {4 * i + 2,
         link.prismatic ? RobotPart::Kind::prismatic_joint : RobotPart::Kind::revolute_joint, i - 1,
         in_frame_before({lines.middle - 0.5 * lines.axis, lines.middle + 0.5 * lines.axis})});
  }
  return parts;
}

namespace {

/// The length of the stretched robot [m].
double robot_size(const RobotModel& model) {
  double size = 0;
  for (const Joint& joint : model.joints()) {
    double d = std::abs(joint.d);
    if (joint.type == Joint::Type::prismatic && std::isfinite(joint.lower) &&
        std::isfinite(joint.upper)) {
      d = std::max(std::abs(joint.d + joint.lower), std::abs(joint.d + joint.upper));
    }
    size += d + std::abs(joint.a);
    if (joint.placement) size += joint.placement->translation().norm();
  }
  return size;
}

}  // namespace

double link_radius(const RobotModel& model) {
  constexpr double kShareOfSize = 0.012;
  return kShareOfSize * robot_size(model);
}

Segment joint_body(const RobotPart& part, double link_radius) {
  const Vector3d middle = 0.5 * (part.segment.from + part.segment.to);
  const Vector3d half = 2 * link_radius * (part.segment.to - part.segment.from);
  return {middle - half, middle + half};
}

}  // namespace armature::monitor::rviz
