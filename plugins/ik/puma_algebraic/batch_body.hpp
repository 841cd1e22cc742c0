// SPDX-License-Identifier: Apache-2.0
// The closed form for as many poses at once as there are lanes, arm by arm; compiled once for each
// kind of processor, everything unnamed so that they never mix. The equations are those of
// four_arms_body.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "forms_body.hpp"
#include "pose_batch.hpp"

namespace armature {
namespace {

using ShortMasks = std::uint16_t __attribute__((vector_size(2 * kLanes)));

/// Which of the arrays' numbers the lanes are; of the last ones there may be less than lanes.
struct Window {
  std::size_t first, count;

  [[gnu::always_inline]] Lanes load(const double* from) const {
    Lanes lanes;
    if (count == kLanes) {
      std::memcpy(&lanes, from + first, sizeof lanes);
    } else {
      for (int i = 0; i < kLanes; ++i) {
        lanes[i] = from[first + std::min(static_cast<std::size_t>(i), count - 1)];
      }
    }
    return lanes;
  }
  void store(const Lanes& lanes, double* to) const {
    if (count == kLanes) {
      std::memcpy(to + first, &lanes, sizeof lanes);
    } else {
      std::memcpy(to + first, &lanes, count * sizeof(double));
    }
  }
  void store(const Masks& bits, std::uint16_t* to) const {
    const auto shorts = __builtin_convertvector(bits, ShortMasks);
    if (count == kLanes) {
      std::memcpy(to + first, &shorts, sizeof shorts);
    } else {
      std::memcpy(to + first, &shorts, count * sizeof(std::uint16_t));
    }
  }
};

inline LaneTriple turned(const double (&R)[3][3], const LaneTriple& v) {
  return {R[0][0] * v.x + R[0][1] * v.y + R[0][2] * v.z,
          R[1][0] * v.x + R[1][1] * v.y + R[1][2] * v.z,
          R[2][0] * v.x + R[2][1] * v.y + R[2][2] * v.z};
}

/// What is asked, seen from the shoulder frame.
struct Goals {
  LaneTriple wrist;  // [m]
  Axes axes;         // the wrist's
  LaneTriple lever;  // from wrist to tool [m]
  Masks bad;
};
[[gnu::always_inline]] inline Goals goals_at(const BatchArm& arm, const PoseBatch& poses,
                                             const Window& window) {
  const LaneTriple at{window.load(poses.position[0]), window.load(poses.position[1]),
                      window.load(poses.position[2])};
  const Lanes w = window.load(poses.rotation[0]), x = window.load(poses.rotation[1]),
              y = window.load(poses.rotation[2]), z = window.load(poses.rotation[3]);
  constexpr double kLeast2 = 1e-18, kMost2 = std::numeric_limits<double>::max();
  const Lanes length2 = w * w + x * x + y * y + z * z, s = 2 / length2;
  const LaneTriple base_x{1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)};
  const LaneTriple base_y{s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)};
  const LaneTriple base_z{s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)};
  const auto axis = [&](int k) {
    const double u = arm.tool_R_wrist[0][k], v = arm.tool_R_wrist[1][k], t = arm.tool_R_wrist[2][k];
    return turned(arm.shoulder_R_base, {base_x.x * u + base_y.x * v + base_z.x * t,
                                        base_x.y * u + base_y.y * v + base_z.y * t,
                                        base_x.z * u + base_y.z * v + base_z.z * t});
  };
  Goals goals;
  goals.axes = {axis(0), axis(1), axis(2)};
  const auto& [n, o, a] = goals.axes;
  const auto& [tx, ty, tz] = arm.wrist_t_tool;
  goals.lever = {n.x * tx + o.x * ty + a.x * tz, n.y * tx + o.y * ty + a.y * tz,
                 n.z * tx + o.z * ty + a.z * tz};
  const LaneTriple tool =
      turned(arm.shoulder_R_base, {at.x - arm.base_t_shoulder[0], at.y - arm.base_t_shoulder[1],
                                   at.z - arm.base_t_shoulder[2]});
  goals.wrist = {tool.x - goals.lever.x, tool.y - goals.lever.y, tool.z - goals.lever.z};
  const Lanes away = larger(larger(magnitude(at.x), magnitude(at.y)), magnitude(at.z));
  goals.bad = ~((away <= arm.farthest) & (at.x == at.x) & (at.y == at.y) & (at.z == at.z) &
                (length2 > kLeast2) & (length2 <= kMost2));
  return goals;
}

/// Joint 1, and what is seen along and across link 1.
struct Shoulder {
  Lanes t1, cos, sin;
  Lanes along;  // of the wrist, from the axis of joint 1 [m]
  LaneTriple seen(const LaneTriple& v) const {
    return {cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z};
  }
};

/// Joints 2 and 3.
struct UpperArm {
  Lanes t2, t3, cos23, sin23;
  LaneTriple miss;  // as of Arms
  /// What a shoulder sees, seen from link 3.
  LaneTriple in_forearm(const LaneTriple& v) const {
    return {cos23 * v.x - sin23 * v.z, -(sin23 * v.x) - cos23 * v.z, v.y};
  }
};
[[gnu::always_inline]] inline UpperArm upper_arm(const ArmNumbers& arm, const LaneTriple& wrist,
                                                 const Lanes& px, const Lanes& rho,
                                                 const Elbows& elbows) {
  const Lanes py = -wrist.z, scale = 1 / (rho * elbows.length);
  const Lanes cos2 = (px * elbows.x + py * elbows.y) * scale,
              sin2 = (py * elbows.x - px * elbows.y) * scale;
  const Lanes forearm_x = cos2 * elbows.cos_psi - sin2 * elbows.sin_psi;  // at t2 + psi
  const Lanes forearm_y = sin2 * elbows.cos_psi + cos2 * elbows.sin_psi;
  UpperArm upper;
  upper.t2 = arctangent(sin2, cos2);
  upper.t3 = elbows.psi - arm.beta;
  upper.cos23 = forearm_x * arm.cos_beta + forearm_y * arm.sin_beta;
  upper.sin23 = forearm_y * arm.cos_beta - forearm_x * arm.sin_beta;
  upper.miss = {arm.a1 + arm.a2 * cos2 + arm.forearm * forearm_x - wrist.x, arm.d2 - wrist.y,
                -(arm.a2 * sin2 + arm.forearm * forearm_y) - wrist.z};
  return upper;
}

/// Into [-pi, pi), of an angle within one and a half turns of zero.
[[gnu::always_inline]] inline Lanes wrapped_once(const Lanes& angle) {
  const Lanes up = angle + (angle < -kPi ? all(2 * kPi) : all(0));
  return up - (up >= kPi ? all(2 * kPi) : all(0));
}

/// Answers of all poses of a window, slot by slot.
class Answers {
 public:
  Answers(const ArmNumbers& arm, const Window& window, const PoseAnswers& out)
      : arm_{arm}, window_{window}, out_{out} {}

  /// The value of joint `i` at `t`; `margin` is how far it is within its limits.
  [[gnu::always_inline]] Lanes joint(int i, const Lanes& t, Lanes& margin) const {
    const Lanes q = wrapped_once(arm_.sign[i] * t - arm_.zero[i]);
    const Lanes offset = magnitude(q - arm_.middle[i]);
    margin = smaller(margin, arm_.half[i] - smaller(offset, magnitude(2 * kPi - offset)));
    return q;
  }
  /// Both wrists of an arm.
  [[gnu::always_inline]] void add(int arm, const Masks& reached, const Masks& singular,
                                  const Lanes (&t)[6]) {
    Lanes margin = all(std::numeric_limits<double>::infinity());
    Lanes upper[3];
    for (int i = 0; i < 3; ++i) upper[i] = joint(i, t[i], margin);
    for (int wrist = 0; wrist < 2; ++wrist) {
      const int slot = 2 * arm + wrist;
      const Lanes turns[3]{wrist == 0 ? t[3] : half_turned(t[3]), wrist == 0 ? t[4] : -t[4],
                           wrist == 0 ? t[5] : half_turned(t[5])};
      Lanes least = margin;
      for (int i = 0; i < 3; ++i) {
        window_.store(upper[i], out_.joint[slot][i]);
        window_.store(joint(i + 3, turns[i], least), out_.joint[slot][i + 3]);
      }
      const std::int64_t bit = std::int64_t{1} << slot;
      found_ |= reached & bit;
      within_ |= reached & (least + 1e-9 >= 0) & bit;
      singular_ |= reached & singular & bit;
    }
  }
  void add_miss(const Masks& reached, const Lanes& position_m, const Lanes& angle_rad) {
    position_m_ = larger(position_m_, reached ? position_m : all(0));
    angle_rad_ = larger(angle_rad_, reached ? angle_rad : all(0));
  }
  void store(const Masks& special) const {
    window_.store(special ? Masks{} + PoseAnswers::kSpecial : found_, out_.found);
    window_.store(within_, out_.within_limits);
    window_.store(singular_, out_.singular);
    window_.store(position_m_, out_.position_m);
    window_.store(angle_rad_, out_.angle_rad);
  }

 private:
  const ArmNumbers& arm_;
  const Window& window_;
  const PoseAnswers& out_;
  Masks found_{}, within_{}, singular_{};
  Lanes position_m_{}, angle_rad_{};
};

/// (37): joint 1 of either shoulder.
[[gnu::always_inline]] inline Shoulder shoulder_at(const ArmNumbers& arm, const LaneTriple& wrist,
                                                   const Lanes& along, const Lanes& scale) {
  const Lanes cos = (along * wrist.x + arm.d2 * wrist.y) * scale,
              sin = (along * wrist.y - arm.d2 * wrist.x) * scale;
  return {arctangent(sin, cos), cos, sin, along};
}

/// Joints 4 to 6 behind an upper arm, and all that is to be said of it; the lanes where axes 4 and
/// 6 are in line.
[[gnu::always_inline]] inline Masks add_wrists(const BatchArm& arm, const LaneTriple& lever,
                                               const Axes& seen, const Shoulder& shoulder,
                                               const UpperArm& upper, const Lanes& sin_elbow,
                                               const Masks& reached, int index, Answers& answers) {
  const Axes wanted{upper.in_forearm(seen.n), upper.in_forearm(seen.o), upper.in_forearm(seen.a)};
  const LaneTriple& a = wanted.a;
  const Lanes sin5 = root(a.x * a.x + a.z * a.z), scale = 1 / sin5;
  const Lanes c4 = -(a.x * scale), s4 = a.z * scale;
  const Lanes s6 = -(wanted.n.x * s4) - wanted.n.z * c4, c6 = -(wanted.o.x * s4) - wanted.o.z * c4;
  const LaneTriple turn = turn_between(wanted, axes_of(c4, s4, a.y, sin5, c6, s6));
  // What the turn makes of the lever, from link 3 to link 1.
  const LaneTriple v = cross(turn, upper.in_forearm(lever));
  const LaneTriple moved{upper.cos23 * v.x - upper.sin23 * v.y, v.z,
                         -(upper.sin23 * v.x) - upper.cos23 * v.y};
  answers.add_miss(reached, norm(upper.miss + moved), norm(turn));
  const double reach = arm.numbers.a2 + arm.numbers.forearm;
  const Lanes from_axis = magnitude(shoulder.along) * (1 / reach);
  const Masks singular = (smaller(smaller(sin_elbow, from_axis), sin5) < kSingular) |
                         (sin_elbow * from_axis * sin5 < kSingularProduct);
  const Lanes t[6]{shoulder.t1,           upper.t2,          upper.t3, arctangent(s4, c4),
                   arctangent(sin5, a.y), arctangent(s6, c6)};
  answers.add(index, reached, singular, t);
  return reached & (sin5 < arm.in_line);
}

void solve_window(const BatchArm& arm, const PoseBatch& poses, const Window& window,
                  const PoseAnswers& out) {
  const ArmNumbers& numbers = arm.numbers;
  const double farthest = numbers.a2 + numbers.forearm,
               nearest = std::fabs(numbers.a2 - numbers.forearm), offset = std::fabs(numbers.d2);
  const Goals goals = goals_at(arm, poses, window);
  const LaneTriple& wrist = goals.wrist;
  const Lanes radius = root(wrist.x * wrist.x + wrist.y * wrist.y), gap = radius - offset;
  const Lanes along =
      gap < kOnRim * farthest ? all(0) : root(larger(gap, all(0)) * (radius + offset));
  const Lanes scale = 1 / (radius * root(along * along + offset * offset));
  Masks special = goals.bad | (radius < kOnAxis * farthest);
  Answers answers{numbers, window, out};
  for (int side = 0; side < 2; ++side) {
    const Shoulder shoulder = shoulder_at(numbers, wrist, side == 0 ? along : -along, scale);
    const LaneTriple seen_wrist = shoulder.seen(wrist), lever = shoulder.seen(goals.lever);
    const Axes seen{shoulder.seen(goals.axes.n), shoulder.seen(goals.axes.o),
                    shoulder.seen(goals.axes.a)};
    const Lanes px = shoulder.along - numbers.a1, rho = root(px * px + wrist.z * wrist.z);
    const Masks reached =
        (gap >= -arm.slack) & (rho - farthest <= arm.slack) & (nearest - rho <= arm.slack);
    special |= reached & (rho < kOnAxis * farthest);
    Elbows elbows = elbows_at(numbers, rho, all(1));
#pragma GCC unroll 2
    for (int elbow = 0; elbow < 2; ++elbow) {
      const UpperArm upper = upper_arm(numbers, seen_wrist, px, rho, elbows);
      special |= add_wrists(arm, lever, seen, shoulder, upper, magnitude(elbows.sin_psi), reached,
                            2 * side + elbow, answers);
      elbows.psi = -elbows.psi, elbows.sin_psi = -elbows.sin_psi, elbows.y = -elbows.y;
    }
  }
  answers.store(special);
}

void solve_all_poses(const BatchArm& arm, const PoseBatch& poses, const PoseAnswers& out) {
  for (std::size_t i = 0; i < poses.count; i += kLanes) {
    solve_window(arm, poses, {i, std::min<std::size_t>(kLanes, poses.count - i)}, out);
  }
}

}  // namespace
}  // namespace armature
