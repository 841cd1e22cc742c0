// SPDX-License-Identifier: Apache-2.0
// The descent itself; compiled once for each kind of processor (portable_kernel.cpp,
// avx2_kernel.cpp), everything in an unnamed namespace so that the two never mix.
#pragma once

#include <cmath>
#include <cstdint>

#include "descent.hpp"
#include "lanes.hpp"
#include "walk.hpp"

namespace armature::ik::numeric::descent {
namespace {

// Levenberg-Marquardt: the damping falls with the error, below kNear with its square, so that the
// end is Newton's quadratic one. Next to a singular pose anything more keeps it from the goal: the
// least is what J J^T is rounded by, a singular value of 1e-8.
constexpr double kDamping = 1e-2, kMinDamping = 1e-16, kNear = 0.1;
constexpr double kMinPivot = 1e-17;  // below it there is only rounding
constexpr int kTimeout = 6;          // iterations in which the error must fall ...
constexpr double kEnoughGain = 0.7;  // ... to this part, or the start is given up
constexpr double kPromise = 0.1;     // and so it is when a step promises less than this part
constexpr int kMaxRows = 6;

/// The Jacobian by columns, and the step it leads to.
template <int Rows>
struct Task {
  Lanes linear[kMaxJoints], angular[kMaxJoints];
  double gram[kMaxRows][kMaxRows];  // J J^T, lower part

  void fill(const Chain& chain, const Axes& axes, const Pose& pose, const Error& error,
            JointSet locked) {
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
    double L[kMaxRows][kMaxRows], inverse[kMaxRows], determinant = 1;
    for (int r = 0; r < Rows; ++r) y[r] = r < 3 ? error.position[r] : error.angle[r - 3];
    for (int k = 0; k < Rows; ++k) {
      double d = gram[k][k] + damping;
      for (int m = 0; m < k; ++m) {
        const double l = L[k][m] * inverse[m];
        d -= L[k][m] * l;
        L[k][m] = l;
      }
      const bool moved = d > kMinPivot;  // what no joint moves is left alone
      inverse[k] = moved ? 1 / d : 0;
      determinant *= moved ? d : 0;
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

  /// dq = J^T y, no joint more than a step may be.
  void step(const double* y, const Chain& chain, double* dq) const {
    const Lanes linear_y{y[0], y[1], y[2], 0};
    const Lanes angular_y{y[3], y[4], Rows > 5 ? y[5] : 0, 0};
    double excess = 1;
    for (int j = 0; j < chain.dof; ++j) {
      dq[j] = dot(linear[j] * linear_y + angular[j] * angular_y, Lanes{1, 1, 1, 0});
      const double part = std::fabs(dq[j]) * chain.per_longest_step[static_cast<std::size_t>(j)];
      excess = part > excess ? part : excess;
    }
    const double scale = 1 / excess;
    for (int j = 0; j < chain.dof; ++j) dq[j] *= scale;
  }
};

/// The joints of `among` at a limit that `dq` would take beyond it.
inline JointSet pressing(const Chain& chain, const double* q, const double* dq, JointSet among) {
  JointSet found = 0;
  for (int j = 0; among != 0; ++j, among >>= 1) {
    if (!(among & 1) || j >= chain.dof) continue;
    const auto at = static_cast<std::size_t>(j);
    const bool down = q[j] <= chain.lower[at] && dq[j] < 0;
    const bool up = q[j] >= chain.upper[at] && dq[j] > 0;
    if (down || up) found |= JointSet{1} << j;
  }
  return found;
}

/// The damped step `dq` from `q`; joints that press against limits they shall keep stay there.
/// `task` is filled. Returns the part of the squared error that the step promises to take away:
/// all of it far from singular poses, next to nothing where the error is least but not zero.
template <int Rows>
double damped_step(const Chain& chain, const Axes& axes, const Pose& pose, const Error& error,
                   Task<Rows>& task, const double* q, End& end, double* dq) {
  const double size = error.size;
  const double damping = kDamping * size * (size < kNear ? size / kNear : 1) + kMinDamping;
  double y[kMaxRows];
  end.pressing = 0;
  for (;;) {
    task.solve(error, damping, y);
    task.step(y, chain, dq);
    if (end.bounded == 0) break;
    const JointSet free = end.bounded & ~end.locked & ~end.pressing;
    const JointSet more = pressing(chain, q, dq, free);
    if (more == 0) break;
    end.pressing |= more;
    task.fill(chain, axes, pose, error, end.locked | end.pressing);
  }
  double kept = 0;  // e.y, of which the damping keeps its part of the error
  for (int r = 0; r < Rows; ++r) kept += y[r] * (r < 3 ? error.position[r] : error.angle[r - 3]);
  return 1 - damping * kept / (size * size);
}

inline void advance(const Chain& chain, const double* dq, JointSet bounded, double* q) {
  for (int j = 0; j < chain.dof; ++j) q[j] += dq[j];
  for (int j = 0; bounded != 0 && j < chain.dof; ++j, bounded >>= 1) {
    const auto at = static_cast<std::size_t>(j);
    if (bounded & 1) q[j] = std::fmin(std::fmax(q[j], chain.lower[at]), chain.upper[at]);
  }
}

inline void keep(const double* q, const Error& error, int dof, End& end) {
  for (int j = 0; j < dof; ++j) end.q[static_cast<std::size_t>(j)] = q[j];
  end.error = error.size;
}

inline bool is_within(const Error& error, const Goal& goal) {
  return std::sqrt(dot(error.position, error.position)) <= goal.position_m &&
         std::sqrt(dot(error.angle, error.angle)) <= goal.chord;
}

template <int Rows>
void descend_rows(const Chain& chain, const Goal& goal, int& budget, End& end) {
  double q[kMaxJoints], dq[kMaxJoints], y[kMaxRows];
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
    if (!within && i % kTimeout == 0) {
      if (!(least < kEnoughGain * to_beat)) return;
      to_beat = least;
    }
    task.fill(chain, axes, pose, error, end.locked);
    if (within) {
      end.reached = true;
      end.position_m = std::sqrt(dot(error.position, error.position));
      end.angle_rad = angle_of_chord(std::sqrt(dot(error.angle, error.angle)));
      if (end.locked != 0) task.fill(chain, axes, pose, error, 0);  // of the whole arm
      end.gram = task.solve(error, 0, y);
      if (polishing || error.size == 0) return;
      if (end.locked != 0) task.fill(chain, axes, pose, error, end.locked);
      polishing = true;  // one more: the tolerance is a bound, not an aim
    }
    const double promised = damped_step(chain, axes, pose, error, task, q, end, dq);
    if (!within && promised < kPromise) return;
    advance(chain, dq, end.bounded, q);
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
}  // namespace armature::ik::numeric::descent
