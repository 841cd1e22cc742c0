// SPDX-License-Identifier: Apache-2.0
#include "blended_way.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <variant>

namespace armature::test {
namespace {

using Eigen::Vector3d;

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

BlendedWay::BlendedWay(const std::vector<ToolPose>& poses, OrientationInterpolator interpolator) {
  for (const ToolPose& pose : poses) {
    add(pose, &pose == &poses.back());
  }
  std::vector<double> turns, ways;
  for (std::size_t i = 1; i < positions_.size(); ++i) {
    turns.push_back(rotations_[i - 1].angularDistance(rotations_[i]));
    ways.push_back((positions_[i] - positions_[i - 1]).norm());
    turn_ += turns.back();
    way_ += ways.back();
  }
  turn_ = std::max(turn_, 0.01);
  way_ = std::max(way_, 0.001);
  if (turns.empty()) return;
  std::vector<double> u{0};
  for (std::size_t i = 0; i < turns.size(); ++i) {
    u.push_back(u.back() + turns[i] / turn_ + ways[i] / way_);
  }
  const double all = u.back();
  for (double& each : u) each /= all;
  const auto curve = OrientationCurve::through(rotations_, interpolator, u);
  if (!curve) throw std::runtime_error{curve.error().text};
  rotation_ = *curve;
  position_.emplace(positions_, u);
}

Miss BlendedWay::miss_of(const Eigen::Isometry3d& tool, const Vector3d& axis) {
  if (!position_) return miss_at(0, tool, axis);
  const auto off = [&](double u) {
    const Miss miss = miss_at(u, tool, axis);
    return std::hypot(miss.position_m / way_, miss.angle_rad / turn_);
  };
  constexpr double kWithin = 0.3;
  constexpr int kParts = 30;
  double from = std::max(0.0, at_ - kWithin), to = std::min(1.0, at_ + kWithin);
  const double part = (to - from) / kParts;
  double nearest = at_;
  for (int i = 0; i <= kParts; ++i) {
    if (off(from + i * part) < off(nearest)) nearest = from + i * part;
  }
  from = std::max(0.0, nearest - part), to = std::min(1.0, nearest + part);
  while (to - from > 1e-7) {
    const double third = (to - from) / 3;
    const bool nearer_to_from = off(from + third) < off(to - third);
    from += nearer_to_from ? 0 : third;
    to -= nearer_to_from ? third : 0;
  }
  at_ = (from + to) / 2;
  return miss_at(at_, tool, axis);
}

Miss BlendedWay::miss_at(double u, const Eigen::Isometry3d& tool, const Vector3d& axis) const {
  const Vector3d position = position_ ? position_->at(u) : positions_.front();
  const Eigen::Quaterniond turn =
      rotation_ ? rotation_->at(u, Rates::none).rotation : rotations_.front();
  const double angle = pointing_ ? angle_between(turn * Vector3d::UnitX(), tool.linear() * axis)
                                 : turn.angularDistance(Eigen::Quaterniond{tool.linear()});
  return {(tool.translation() - position).norm(), angle};
}

void BlendedWay::add(const ToolPose& pose, bool is_goal) {
  Eigen::Quaterniond turn;
  const auto* direction = std::get_if<Direction>(&pose.orientation);
  pointing_ = direction;
  if (!direction) {
    turn = std::get<Eigen::Quaterniond>(pose.orientation);
  } else if (rotations_.empty()) {
    // How it is turned about its direction is told nowhere; rotvec_bspline depends on it.
    Eigen::Matrix3d R;
    R << direction->unit, direction->unit.unitOrthogonal(),
        direction->unit.cross(direction->unit.unitOrthogonal());
    turn = Eigen::Quaterniond{R};
  } else {
    const Vector3d before = rotations_.back() * Vector3d::UnitX();
    turn = Eigen::Quaterniond::FromTwoVectors(before, direction->unit) * rotations_.back();
  }
  constexpr double kSame = 1e-6;
  if (!rotations_.empty() && (pose.position - positions_.back()).norm() <= kSame &&
      turn.angularDistance(rotations_.back()) <= kSame) {
    if (!is_goal || positions_.size() == 1) return;
    positions_.pop_back();
    rotations_.pop_back();
  }
  positions_.push_back(pose.position);
  rotations_.push_back(turn);
}

}  // namespace armature::test
