// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>

#include "armature/kinds/ik/contract/postures.hpp"
#include "armature/kinds/ik/contract/search.hpp"
#include "armature/robot/kinematics/kinematics.hpp"

namespace armature::ik_contract {
namespace {

constexpr int kIterations = 60;
constexpr double kReached = 1e-13;
constexpr int kTries = 10;  // per posture that is wanted

/// Two things that shall become zero, and how the joints change them.
struct Aim {
  Eigen::Vector2d error;
  Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, kMaxJoints> jacobian;
};

/// Damped Gauss-Newton from `q`, within limits; none when it ends elsewhere.
template <class AimAt>
std::optional<JointVector> aimed(const RobotModel& model, JointVector q, AimAt aim_at) {
  for (int i = 0; i < kIterations; ++i) {
    const Aim aim = aim_at(q);
    if (aim.error.norm() <= kReached) return q;
    Eigen::Matrix2d A = aim.jacobian * aim.jacobian.transpose();
    A.diagonal().array() += 1e-3 * aim.error.squaredNorm() + 1e-15;
    q -= aim.jacobian.transpose() * A.ldlt().solve(aim.error);
    for (int k = 0; k < model.dof(); ++k) {
      const auto [lower, upper] = range_of(model, k);
      q[k] = std::clamp(q[k], lower, upper);
    }
  }
  return std::nullopt;
}

template <class AimAt>
std::vector<JointVector> aimed_postures(const RobotModel& model, int count, Random& random,
                                        AimAt aim_at) {
  std::vector<JointVector> postures;
  for (int i = 0; i < kTries * count && static_cast<int>(postures.size()) < count; ++i) {
    if (i >= 20 * kTries && postures.empty()) break;  // there is none
    if (auto q = aimed(model, random_posture(model, random), aim_at)) postures.push_back(*q);
  }
  return postures;
}

}  // namespace

std::vector<JointVector> postures_on_base_axis(const RobotModel& model, int count, Random& random) {
  const BaseAxis axis = base_axis(model);
  const Eigen::Vector3d side = axis.direction.unitOrthogonal(), up = axis.direction.cross(side);
  return aimed_postures(model, count, random, [&](const JointVector& q) {
    const auto [pose, J] = forward_kinematics_with_jacobian(model, q, model.tool());
    const Eigen::Vector3d from_axis = pose.translation() - axis.point;
    Aim aim{{from_axis.dot(side), from_axis.dot(up)}, {}};
    aim.jacobian.resize(2, model.dof());
    aim.jacobian << side.transpose() * J.topRows<3>(), up.transpose() * J.topRows<3>();
    return aim;
  });
}

std::vector<JointVector> upright_postures(const RobotModel& model, double up, int count,
                                          Random& random) {
  const Eigen::Vector3d axis = model.pointing_axis().value_or(Eigen::Vector3d::UnitZ());
  // The error is zero pointing the other way, too: half of them are not meant.
  auto postures = aimed_postures(model, 2 * count, random, [&](const JointVector& q) {
    const auto [pose, J] = forward_kinematics_with_jacobian(model, q, model.tool());
    const Eigen::Vector3d u = pose.linear() * axis;
    Aim aim{u.head<2>(), {}};
    aim.jacobian.resize(2, model.dof());
    for (int k = 0; k < model.dof(); ++k) {
      aim.jacobian.col(k) = J.col(k).tail<3>().cross(u).head<2>();
    }
    return aim;
  });
  std::erase_if(postures, [&](const JointVector& q) {
    return up * (forward_kinematics(model, q).linear() * axis).z() < 0;
  });
  if (static_cast<int>(postures.size()) > count) postures.resize(static_cast<std::size_t>(count));
  return postures;
}

}  // namespace armature::ik_contract
