// SPDX-License-Identifier: Apache-2.0
// The descent itself; compiled once for each kind of processor (portable_kernel.cpp,
// avx2_kernel.cpp), everything in an unnamed namespace so that the two never mix.
#pragma once

#include <cmath>
#include <cstdint>

#include "descent.hpp"
#include "lanes.hpp"

namespace armature::descent {
namespace {

// Levenberg-Marquardt: the damping falls with the error, below kNear with its square, so that the
// end is Newton's quadratic one; next to a singular pose anything more keeps it from the goal.
constexpr double kDamping = 1e-2, kLeastDamping = 1e-14, kNear = 0.1;
constexpr double kLongestStep = 1.0;  // [rad] or [m], of any joint
constexpr int kPatience = 6;          // iterations in which the error must fall ...
constexpr double kEnoughGain = 0.7;   // ... to this part, or the start is given up
constexpr int kMostRows = 6;

/// The tool at some joint position.
struct Pose {
  Lanes x, y, z, origin;
};
/// Where the joints' axes are.
struct Axes {
  Lanes direction[kMaxJoints], point[kMaxJoints];
};

inline Pose walk(const Chain& chain, const double* q, Axes& axes) {
  constexpr int kPadded = (kMaxJoints + 3) / 4 * 4;
  alignas(32) double value[kPadded], sine[kPadded], cosine[kPadded];
  for (int i = 0; i < chain.joints; ++i) {
    const Chain::Step& step = chain.step[i];
    value[i] = step.ratio * q[step.independent] + step.offset;
  }
  for (int i = chain.joints; i % 4 != 0; ++i) value[i] = 0;
  for (int i = 0; i < chain.joints; i += 4) sine_and_cosine(value + i, sine + i, cosine + i);

  Pose frame{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 0}};
  const auto carry = [&frame](const Lanes& x, const Lanes& y, const Lanes& z, const Lanes& origin) {
    const Pose f = frame;
    frame.x = f.x * x[0] + f.y * x[1] + f.z * x[2];
    frame.y = f.x * y[0] + f.y * y[1] + f.z * y[2];
    frame.z = f.x * z[0] + f.y * z[1] + f.z * z[2];
    frame.origin = f.origin + f.x * origin[0] + f.y * origin[1] + f.z * origin[2];
  };
  for (int i = 0; i < chain.joints; ++i) {
    const Chain::Step& step = chain.step[i];
    carry(step.x, step.y, step.z, step.origin);
    axes.direction[i] = frame.z;
    axes.point[i] = frame.origin;
    if (step.prismatic) {
      frame.origin += frame.z * value[i];
    } else {
      const Lanes x = frame.x;
      frame.x = x * cosine[i] + frame.y * sine[i];
      frame.y = frame.y * cosine[i] - x * sine[i];
    }
  }
  carry(chain.tool_x, chain.tool_y, chain.tool_z, chain.tool_origin);
  return frame;
}

// What is left to turn is told by its chord: twice the sine of half the angle, along the axis. It
// equals the rotation vector to third order, is never shorter than 2/pi of it, and needs no
// transcendental functions. From the sine (along the axis) and the square of half the angle's
// cosine it is sine / cosine; next to half a turn, where both vanish, the length alone tells it.
constexpr double kHalfTurn = 1e-6;  // of that square
inline double length_of_chord(double half) { return 2 * std::sqrt(1 - std::fmax(0.0, half)); }
inline double angle_of_chord(double chord) { return 2 * std::asin(std::fmin(1.0, 0.5 * chord)); }

/// The task error, and the two directions in which a pointing axis can move.
struct Error {
  Lanes position, angle;  // angle: the chord; of pointing goals two numbers, about side and up
  Lanes side, up;
  double size;
};

inline Lanes any_square_to(const Lanes& u) {
  const Lanes other = std::fabs(u[0]) < 0.7 ? Lanes{1, 0, 0, 0} : Lanes{0, 1, 0, 0};
  const Lanes v = cross(u, other);
  return v / std::sqrt(dot(v, v));
}

/// The axis of nearly half a turn, unit: every column of turn + 1 lies along it.
inline Lanes half_turn_axis(const Goal& goal, const Pose& pose) {
  const Lanes c0 = goal.x * pose.x[0] + goal.y * pose.y[0] + goal.z * pose.z[0] + Lanes{1, 0, 0, 0};
  const Lanes c1 = goal.x * pose.x[1] + goal.y * pose.y[1] + goal.z * pose.z[1] + Lanes{0, 1, 0, 0};
  const Lanes c2 = goal.x * pose.x[2] + goal.y * pose.y[2] + goal.z * pose.z[2] + Lanes{0, 0, 1, 0};
  Lanes axis = dot(c1, c1) > dot(c0, c0) ? c1 : c0;
  if (dot(c2, c2) > dot(axis, axis)) axis = c2;
  return axis / std::sqrt(dot(axis, axis));
}

inline Error pointing_error(const Chain& chain, const Goal& goal, const Pose& pose) {
  const Lanes& a = chain.pointing_axis;
  const Lanes u = pose.x * a[0] + pose.y * a[1] + pose.z * a[2];
  Error error;
  error.position = goal.position - pose.origin;
  error.side = any_square_to(u);
  error.up = cross(u, error.side);
  const Lanes sine = cross(u, goal.x);
  const double half = 0.5 * (1 + dot(u, goal.x));
  error.angle = Lanes{dot(sine, error.side), dot(sine, error.up), 0, 0};
  if (half > kHalfTurn) {
    error.angle /= std::sqrt(half);
  } else {
    const double length = std::sqrt(dot(error.angle, error.angle));
    error.angle = length > 0 ? error.angle / length : Lanes{1, 0, 0, 0};  // opposite: any axis
    error.angle *= length_of_chord(half);
  }
  error.size = std::sqrt(dot(error.position, error.position) + dot(error.angle, error.angle));
  return error;
}

inline Error rotation_error(const Goal& goal, const Pose& pose) {
  Error error;
  error.position = goal.position - pose.origin;
  const Lanes sine = 0.5 * (cross(pose.x, goal.x) + cross(pose.y, goal.y) + cross(pose.z, goal.z));
  const double trace = dot(pose.x, goal.x) + dot(pose.y, goal.y) + dot(pose.z, goal.z);
  const double half = 0.25 * (1 + trace);
  if (half > kHalfTurn) {
    error.angle = sine / std::sqrt(half);
  } else {
    const Lanes axis = half_turn_axis(goal, pose);
    error.angle = axis * std::copysign(length_of_chord(half), dot(axis, sine));
  }
  error.size = std::sqrt(dot(error.position, error.position) + dot(error.angle, error.angle));
  return error;
}

template <int Rows>
inline Error error_at(const Chain& chain, const Goal& goal, const Pose& pose) {
  if constexpr (Rows == 5) return pointing_error(chain, goal, pose);
  return rotation_error(goal, pose);
}

/// The Jacobian by columns, and the step it leads to.
template <int Rows>
struct Task {
  Lanes linear[kMaxJoints], angular[kMaxJoints];
  double gram[kMostRows][kMostRows];  // J J^T, lower part

  void fill(const Chain& chain, const Axes& axes, const Pose& pose, const Error& error,
            std::uint32_t locked) {
    for (int j = 0; j < chain.dof; ++j) linear[j] = angular[j] = Lanes{};
    for (int i = 0; i < chain.joints; ++i) {
      const Chain::Step& step = chain.step[i];
      const int j = step.independent;
      if (step.prismatic) {
        linear[j] += step.ratio * axes.direction[i];
      } else {
        const Lanes omega = step.ratio * axes.direction[i];
        linear[j] += cross(omega, pose.origin - axes.point[i]);
        angular[j] += omega;
      }
    }
    for (int j = 0; locked != 0; ++j, locked >>= 1) {
      if (locked & 1) linear[j] = angular[j] = Lanes{};
    }
    if constexpr (Rows == 5) {
      for (int j = 0; j < chain.dof; ++j) {
        angular[j] = Lanes{dot(angular[j], error.side), dot(angular[j], error.up), 0, 0};
      }
    }
    multiply(chain.dof);
  }

  void multiply(int dof) {
    Lanes ll[3]{}, al[3]{}, aa[3]{};
    for (int j = 0; j < dof; ++j) {
      for (int k = 0; k < 3; ++k) {
        ll[k] += linear[j] * linear[j][k];
        al[k] += angular[j] * linear[j][k];
        if (k < Rows - 3) aa[k] += angular[j] * angular[j][k];
      }
    }
    for (int k = 0; k < 3; ++k) {
      for (int r = k; r < 3; ++r) gram[r][k] = ll[k][r];
      for (int r = 3; r < Rows; ++r) gram[r][k] = al[k][r - 3];
    }
    for (int k = 3; k < Rows; ++k) {
      for (int r = k; r < Rows; ++r) gram[r][k] = aa[k - 3][r - 3];
    }
  }

  /// (J J^T + damping)^-1 e by L D L^T; the product of D is the determinant.
  double solve(const Error& error, double damping, double* y) const {
    double L[kMostRows][kMostRows], inverse[kMostRows], determinant = 1;
    for (int r = 0; r < Rows; ++r) y[r] = r < 3 ? error.position[r] : error.angle[r - 3];
    for (int k = 0; k < Rows; ++k) {
      double d = gram[k][k] + damping;
      for (int m = 0; m < k; ++m) {
        const double l = L[k][m] * inverse[m];
        d -= L[k][m] * l;
        L[k][m] = l;
      }
      d = d > 1e-300 ? d : 1e-300;
      inverse[k] = 1 / d;
      determinant *= d;
      for (int r = k + 1; r < Rows; ++r) {
        double l = gram[r][k];
        for (int m = 0; m < k; ++m) l -= L[r][m] * L[k][m];
        L[r][k] = l;  // times d, until its own row is reached
      }
      for (int m = 0; m < k; ++m) y[k] -= L[k][m] * y[m];
    }
    for (int k = Rows - 1; k >= 0; --k) {
      y[k] *= inverse[k];
      for (int r = k + 1; r < Rows; ++r) y[k] -= L[r][k] * y[r];
    }
    return determinant;
  }

  /// Moves `q` by J^T y, no joint more than a step may be.
  void move(const double* y, int dof, double* q) const {
    const Lanes linear_y{y[0], y[1], y[2], 0};
    const Lanes angular_y{y[3], y[4], Rows > 5 ? y[5] : 0, 0};
    double dq[kMaxJoints], longest = 0;
    for (int j = 0; j < dof; ++j) {
      dq[j] = dot(linear[j] * linear_y + angular[j] * angular_y, Lanes{1, 1, 1, 0});
      longest = std::fmax(longest, std::fabs(dq[j]));
    }
    const double scale = longest > kLongestStep ? kLongestStep / longest : 1;
    for (int j = 0; j < dof; ++j) q[j] += scale * dq[j];
  }
};

inline void keep(const double* q, const Error& error, int dof, End& end) {
  for (int j = 0; j < dof; ++j) end.q[static_cast<std::size_t>(j)] = q[j];
  end.position_m = std::sqrt(dot(error.position, error.position));
  end.angle_rad = angle_of_chord(std::sqrt(dot(error.angle, error.angle)));
  end.error = error.size;
}

inline bool is_within(const Error& error, const Goal& goal) {
  return std::sqrt(dot(error.position, error.position)) <= goal.position_m &&
         std::sqrt(dot(error.angle, error.angle)) <= goal.chord;
}

template <int Rows>
void descend_rows(const Chain& chain, const Goal& goal, int& budget, End& end) {
  double q[kMaxJoints], y[kMostRows];
  for (int j = 0; j < chain.dof; ++j) q[j] = end.q[static_cast<std::size_t>(j)];
  Axes axes;
  Task<Rows> task;
  double least = HUGE_VAL, to_beat = HUGE_VAL;
  bool polishing = false;
  end.error = HUGE_VAL;
  end.reached = false;
  for (int i = 0; budget > 0; ++i, --budget) {
    const Pose pose = walk(chain, q, axes);
    const Error error = error_at<Rows>(chain, goal, pose);
    const bool within = is_within(error, goal);
    if (polishing && !(within && error.size < least)) return;
    if (error.size < least || within) {
      least = error.size;
      keep(q, error, chain.dof, end);
    }
    if (!within && i % kPatience == 0) {
      if (!(least < kEnoughGain * to_beat)) return;
      to_beat = least;
    }
    task.fill(chain, axes, pose, error, end.locked);
    if (within) {
      end.reached = true;
      if (end.locked != 0) task.fill(chain, axes, pose, error, 0);  // of the whole arm
      end.gram = task.solve(error, 0, y);
      if (polishing || error.size == 0) return;
      if (end.locked != 0) task.fill(chain, axes, pose, error, end.locked);
      polishing = true;  // one more: the tolerance is a bound, not an aim
    }
    const double size = error.size;
    task.solve(error, kDamping * size * (size < kNear ? size / kNear : 1) + kLeastDamping, y);
    task.move(y, chain.dof, q);
  }
}

void descend_any(const Chain& chain, const Goal& goal, int& budget, End& end) {
  if (goal.pointing) {
    descend_rows<5>(chain, goal, budget, end);
  } else {
    descend_rows<6>(chain, goal, budget, end);
  }
}

double measure_any(const Chain& chain, const Goal& goal, const double* q) {
  Axes axes;
  const Pose pose = walk(chain, q, axes);
  return (goal.pointing ? pointing_error(chain, goal, pose) : rotation_error(goal, pose)).size;
}

}  // namespace
}  // namespace armature::descent
