// SPDX-License-Identifier: Apache-2.0
// Where the joints bring the tool, and how far that is from the goal, for descent_body.hpp: unnamed
// on purpose, as that is.
#pragma once

#include <cmath>
#include <cstring>

#include "descent.hpp"
#include "lanes.hpp"

namespace armature::ik::numeric::descent {
namespace {

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
  for (int i = 0; i < chain.joints; i += 4) {
    Lanes angles;
    std::memcpy(&angles, value + i, sizeof angles);
    const LaneSinCos turned = sine_and_cosine(angles);
    std::memcpy(sine + i, &turned.sin, sizeof angles);
    std::memcpy(cosine + i, &turned.cos, sizeof angles);
  }

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

}  // namespace
}  // namespace armature::ik::numeric::descent
