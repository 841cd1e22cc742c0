// SPDX-License-Identifier: Apache-2.0
#include "reach.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace armature::ik::numeric {
namespace {

using descent::Chain;
using descent::Lanes;
using Eigen::Vector3d;

constexpr double kRounding = 1e-12;  // [m] of a goal at the rim of what the arm reaches
constexpr double kOnAxis = 1e-12;    // [m] off an axis, or sine between parallel ones
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vector3d vector(const Lanes& v) { return {v[0], v[1], v[2]}; }

/// A joint's axis while every joint's value is zero, in the base frame.
struct Axis {
  Vector3d point, z;
  bool slides;
  double lower, upper;  // [m] of a slide

  double distance(const Vector3d& p) const { return (p - point).cross(z).norm(); }
  Vector3d foot(const Vector3d& p) const { return point + (p - point).dot(z) * z; }
};

/// A point that does not move with the links `first` to `last`: 0 is the base, i what joint i
/// moves.
struct Node {
  Vector3d at;
  int first, last;
};

struct Span {
  double least, most;
};

/// The arm at rest: its axes, and where the tool is.
struct Rest {
  std::vector<Axis> axes;
  Eigen::Isometry3d base_T_tool;
};

Eigen::Isometry3d transform(const Lanes& x, const Lanes& y, const Lanes& z, const Lanes& origin) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << vector(x), vector(y), vector(z);
  T.translation() = vector(origin);
  return T;
}

Rest rest_of(const Chain& chain) {
  Rest rest;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int i = 0; i < chain.joints; ++i) {
    const auto& step = chain.step[static_cast<std::size_t>(i)];
    T = T * transform(step.x, step.y, step.z, step.origin);
    const auto of = static_cast<std::size_t>(step.independent);
    const double a = step.ratio * chain.lower[of] + step.offset;
    const double b = step.ratio * chain.upper[of] + step.offset;
    rest.axes.push_back(
        {T.translation(), T.linear().col(2), step.prismatic, std::min(a, b), std::max(a, b)});
  }
  rest.base_T_tool = T * transform(chain.tool_x, chain.tool_y, chain.tool_z, chain.tool_origin);
  return rest;
}

/// Where the common normal of `a` and `b` stands on `a`; of parallel axes, beside b's own point.
Vector3d foot_of_normal(const Axis& a, const Axis& b) {
  const Vector3d n = a.z.cross(b.z);
  const double sine2 = n.squaredNorm();
  if (sine2 < kOnAxis * kOnAxis) return a.foot(b.point);
  return a.point + (b.point - a.point).cross(b.z).dot(n) / sine2 * a.z;
}

/// A point of link `link`, with all the links that it does not move with either.
Node node_at(const std::vector<Axis>& axes, const Vector3d& at, int link) {
  const auto turns_about = [&](int joint) {
    const Axis& axis = axes[static_cast<std::size_t>(joint - 1)];
    return !axis.slides && axis.distance(at) <= kOnAxis;
  };
  Node node{at, link, link};
  while (node.first > 0 && turns_about(node.first)) --node.first;
  while (node.last < static_cast<int>(axes.size()) && turns_about(node.last + 1)) ++node.last;
  return node;
}

/// The feet of the normals between neighbouring axes, each axis' own point, and the tool.
std::vector<Node> nodes_of(const Rest& rest) {
  std::vector<Node> nodes;
  const auto& axes = rest.axes;
  const int n = static_cast<int>(axes.size());
  const auto add = [&](const Vector3d& at, int link) {
    const Node node = node_at(axes, at, link);
    const bool known = std::ranges::any_of(nodes, [&](const Node& other) {
      return other.first == node.first && other.last == node.last &&
             (other.at - node.at).norm() <= kOnAxis;
    });
    if (!known) nodes.push_back(node);
  };
  for (int i = 1; i <= n; ++i) {
    const Axis& axis = axes[static_cast<std::size_t>(i - 1)];
    for (const int link : {i - 1, i}) {
      add(axis.point, link);
      if (i > 1) add(foot_of_normal(axis, axes[static_cast<std::size_t>(i - 2)]), link);
      if (i < n) add(foot_of_normal(axis, axes[static_cast<std::size_t>(i)]), link);
    }
  }
  add(rest.base_T_tool.translation(), n);
  return nodes;
}

/// The distances that turning or sliding along `axis` lets `b`, which it moves, have from `a`.
Span distances(const Axis& axis, const Vector3d& a, const Vector3d& b) {
  const Vector3d u = a - axis.point, v = b - axis.point;
  const double height = (v - u).dot(axis.z);
  const double from_a = u.cross(axis.z).norm(), from_b = v.cross(axis.z).norm();
  if (!axis.slides) {
    return {std::hypot(height, from_a - from_b), std::hypot(height, from_a + from_b)};
  }
  const double side = (v - u - height * axis.z).norm();
  const double low = height + axis.lower, high = height + axis.upper;
  const double nearest = low <= 0 && high >= 0 ? 0 : std::min(std::abs(low), std::abs(high));
  return {std::hypot(side, nearest), std::hypot(side, std::max(std::abs(low), std::abs(high)))};
}

/// Distances of two points that at most one joint lies between; else anything.
Span direct(const std::vector<Axis>& axes, const Node& a, const Node& b) {
  if (a.first > b.last) return direct(axes, b, a);
  if (b.first <= a.last) {
    const double constant = (a.at - b.at).norm();
    return {constant, constant};
  }
  if (b.first > a.last + 1) return {0, kInfinity};
  return distances(axes[static_cast<std::size_t>(b.first - 1)], a.at, b.at);
}

/// Bounds of the distance of every two points of the arm.
class Distances {
 public:
  Distances(const std::vector<Axis>& axes, const std::vector<Node>& nodes) : n_{nodes.size()} {
    for (const Node& a : nodes) {
      for (const Node& b : nodes) {
        const Span span = direct(axes, a, b);
        least_.push_back(span.least);
        most_.push_back(span.most);
      }
    }
    // The shortest ways (R. W. Floyd, "Algorithm 97", Communications of the ACM 5(6), 1962).
    for (std::size_t k = 0; k < n_; ++k) {
      for (std::size_t i = 0; i < n_; ++i) {
        for (std::size_t j = 0; j < n_; ++j) {
          most_[at(i, j)] = std::min(most_[at(i, j)], most_[at(i, k)] + most_[at(k, j)]);
        }
      }
    }
  }

  double most(std::size_t a, std::size_t b) const { return most_[at(a, b)]; }
  /// What the longest part of the way leaves when all the others point back.
  double least(std::size_t a, std::size_t b) const {
    double best = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j) {
        best = std::max(best, least_[at(i, j)] - most_[at(a, i)] - most_[at(j, b)]);
      }
    }
    return best;
  }

 private:
  std::size_t at(std::size_t i, std::size_t j) const { return i * n_ + j; }

  std::size_t n_;
  std::vector<double> least_, most_;
};

/// How far along the pointing axis from the tool's origin `point` (of the tool frame) is; NaN when
/// it is beside that, or there is none.
double along_pointing(const RobotModel& model, const Vector3d& point) {
  if (point.norm() <= kOnAxis) return 0;
  if (!model.pointing_axis()) return std::numeric_limits<double>::quiet_NaN();
  const double along = point.dot(*model.pointing_axis());
  const bool on_it = (point - along * *model.pointing_axis()).norm() <= kOnAxis;
  return on_it ? along : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Reach::Reach(const RobotModel& model, const Chain& chain) {
  const Rest rest = rest_of(chain);
  const std::vector<Node> nodes = nodes_of(rest);
  const Distances distances{rest.axes, nodes};
  const Eigen::Isometry3d tool_T_base = rest.base_T_tool.inverse();
  for (std::size_t q = 0; q < nodes.size(); ++q) {
    if (nodes[q].last < chain.joints) continue;
    // Of all points of the base, that of the least outer and that of the greatest inner radius.
    std::optional<Shell> least, greatest;
    for (std::size_t p = 0; p < nodes.size(); ++p) {
      if (nodes[p].first > 0) continue;
      const Vector3d point = tool_T_base * nodes[q].at;
      const Shell shell{nodes[p].at, point, along_pointing(model, point), distances.least(p, q),
                        distances.most(p, q)};
      if (!least || shell.outer < least->outer) least = shell;
      if (!greatest || shell.inner > greatest->inner) greatest = shell;
    }
    if (!least) continue;
    shells_.push_back(*least);
    if (greatest->inner > 0 && greatest->centre != least->centre) shells_.push_back(*greatest);
  }
}

std::optional<Reach::Miss> Reach::miss_of(const IkGoal& goal) const {
  const auto* direction = std::get_if<Direction>(&goal.pose.orientation);
  Vector3d unit = Vector3d::Zero();
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  if (direction) {
    unit = direction->unit.normalized();
  } else {
    R = std::get<Eigen::Quaterniond>(goal.pose.orientation).normalized().toRotationMatrix();
  }
  std::optional<Miss> miss;
  for (const Shell& shell : shells_) {
    if (direction && std::isnan(shell.along)) continue;
    const Vector3d lever = direction ? Vector3d{shell.along * unit} : Vector3d{R * shell.point};
    const double distance = (goal.pose.position + lever - shell.centre).norm();
    const bool near = distance < shell.inner;
    const double by = near ? shell.inner - distance : distance - shell.outer;
    const double forgiven =
        goal.tolerance.position_m + goal.tolerance.angle_rad * shell.point.norm() + kRounding;
    if (by <= forgiven || (miss && by <= miss->by)) continue;
    miss = Miss{by, near ? "nearer than the arm folds" : "longer than the arm"};
  }
  return miss;
}

}  // namespace armature::ik::numeric
