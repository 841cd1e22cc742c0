// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/kinematics/kinematics.hpp"

#include <Eigen/QR>
#include <array>
#include <cmath>

#include "armature/robot/kinematics/task_error.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

/// A frame that is carried along the chain: its axes and its origin, seen from the base.
struct Carried {
  Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  Vector3d origin = Vector3d::Zero();

  /// Rz(theta) Tz(d)
  void screw_along_z(double theta, double d) {
    const double c = std::cos(theta), s = std::sin(theta);
    const Vector3d turned = c * x + s * y;
    y = c * y - s * x;
    x = turned;
    origin += d * z;
  }
  /// Tx(a) Rx(alpha)
  void screw_along_x(const ChainLink& link) {
    const Vector3d turned = link.cos_alpha * y + link.sin_alpha * z;
    z = link.cos_alpha * z - link.sin_alpha * y;
    y = turned;
    origin += link.a * x;
  }

  void place(const Eigen::Isometry3d& placement) {
    Eigen::Matrix3d axes;
    axes << x, y, z;
    origin += axes * placement.translation();
    axes *= placement.linear();
    x = axes.col(0), y = axes.col(1), z = axes.col(2);
  }

  Eigen::Isometry3d pose() const {
    Eigen::Isometry3d result;
    result.matrix() << x, y, z, origin, 0, 0, 0, 1;
    return result;
  }
};

/// The line about which, or along which, a joint moves.
struct Axis {
  Vector3d direction, point;
};

/// `kPlaced`: rows are placed; the others do not even ask.
template <bool kPlaced, class Visit>
Carried walk_rows(const RobotModel& model, const JointVector& q, int last, Visit visit) {
  const bool modified = model.convention() == RobotModel::Convention::modified;
  Carried frame;
  for (int i = 0; i <= last; ++i) {
    const ChainLink& link = model.chain()[static_cast<std::size_t>(i)];
    const double value = link.ratio * q[link.independent] + link.offset;
    if constexpr (kPlaced) frame.place(link.placement);
    if (modified) frame.screw_along_x(link);
    const Axis axis{frame.z, frame.origin};
    frame.screw_along_z(link.prismatic ? link.theta : link.theta + value,
                        link.prismatic ? link.d + value : link.d);
    if (!modified) frame.screw_along_x(link);
    visit(i, axis, frame);
  }
  return frame;
}

/// Walks to joint `last`; `visit(i, axis, frame)` is told every joint's axis and frame on the way.
template <class Visit>
Carried walk(const RobotModel& model, const JointVector& q, int last, Visit visit) {
  return model.is_placed() ? walk_rows<true>(model, q, last, visit)
                           : walk_rows<false>(model, q, last, visit);
}

using Axes = std::array<Axis, kMaxJoints>;

/// Walks to joint `last` and notes the axes on the way.
Carried walk_axes(const RobotModel& model, const JointVector& q, int last, Axes& axes) {
  return walk(model, q, last, [&](int i, const Axis& axis, const Carried&) {
    axes[static_cast<std::size_t>(i)] = axis;
  });
}

/// Of the point `tip`, which joint `last` carries, seen from the base.
Jacobian jacobian_at(const RobotModel& model, const Axes& axes, int last, const Vector3d& tip) {
  Jacobian jacobian = Jacobian::Zero(6, model.dof());
  for (int i = 0; i <= last; ++i) {
    const auto& [direction, point] = axes[static_cast<std::size_t>(i)];
    const ChainLink& link = model.chain()[static_cast<std::size_t>(i)];
    auto column = jacobian.col(link.independent);
    if (link.prismatic) {
      column.head<3>() += link.ratio * direction;
    } else {
      column.head<3>() += link.ratio * direction.cross(tip - point);
      column.tail<3>() += link.ratio * direction;
    }
  }
  return jacobian;
}

Eigen::Isometry3d frame_on(const Carried& link, const NamedFrame& frame) {
  return link.pose() * frame.parent_T_frame;
}

}  // namespace

Eigen::Isometry3d forward_kinematics(const RobotModel& model, const JointVector& q, FrameId frame) {
  const NamedFrame& named = model.frame(frame);
  return frame_on(walk(model, q, named.parent_joint, [](int, const Axis&, const Carried&) {}),
                  named);
}

Eigen::Isometry3d forward_kinematics(const RobotModel& model, const JointVector& q) {
  return forward_kinematics(model, q, model.tool());
}

void joint_frames(const RobotModel& model, const JointVector& q,
                  std::span<Eigen::Isometry3d> base_T_joint) {
  walk(model, q, model.joint_count() - 1, [&](int i, const Axis&, const Carried& frame) {
    base_T_joint[static_cast<std::size_t>(i)] = frame.pose();
  });
}

PoseAndJacobian forward_kinematics_with_jacobian(const RobotModel& model, const JointVector& q,
                                                 FrameId frame) {
  const NamedFrame& named = model.frame(frame);
  Axes axes;
  const Carried last = walk_axes(model, q, named.parent_joint, axes);
  const Eigen::Isometry3d base_T_frame = frame_on(last, named);
  return {base_T_frame, jacobian_at(model, axes, named.parent_joint, base_T_frame.translation())};
}

Jacobian point_jacobian(const RobotModel& model, const JointVector& q, int parent,
                        const Vector3d& point) {
  Axes axes;
  const Carried last = walk_axes(model, q, parent, axes);
  return jacobian_at(model, axes, parent, last.pose() * point);
}

double manipulability(const RobotModel& model, const JointVector& q) {
  const TaskJacobian task = task_jacobian(model, q);
  if (task.cols() < task.rows()) return 0;
  // sqrt(det(J J^T)) is the product of the diagonal of R in J^T P = Q R; squaring J would cost half
  // of the digits near a singularity.
  using Transposed = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxJoints, 6>;
  const Transposed transposed = task.transpose();
  const Eigen::ColPivHouseholderQR<Transposed> qr(transposed);
  return std::abs(qr.matrixQR().diagonal().head(task.rows()).prod());
}

}  // namespace armature
