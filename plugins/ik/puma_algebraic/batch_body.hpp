// SPDX-License-Identifier: Apache-2.0
// As many poses at once as there are lanes, arm by arm; see forms_body.hpp.
#pragma once

#include <algorithm>

#include "armature/kinds/ik/farthest.hpp"
#include "forms_body.hpp"

namespace armature {
namespace {

using ShortMasks = std::uint16_t __attribute__((vector_size(2 * kLanes)));

inline Lanes load(const double* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline void store(const Masks& bits, std::uint16_t* to) {
  const auto shorts = __builtin_convertvector(bits, ShortMasks);
  std::memcpy(to, &shorts, sizeof shorts);
}

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
[[gnu::always_inline]] inline Goals goals_at(const ArmNumbers& arm, const PoseBatch& poses,
                                             std::size_t first) {
  const auto& [px, py, pz] = poses.position;
  const auto& [qw, qx, qy, qz] = poses.rotation;
  const LaneTriple at{load(px + first), load(py + first), load(pz + first)};
  const Lanes w = load(qw + first), x = load(qx + first), y = load(qy + first),
              z = load(qz + first);
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
  goals.bad = ~((away <= kFarthest) & (at.x == at.x) & (at.y == at.y) & (at.z == at.z) &
                (length2 > kLeast2) & (length2 <= kMost2));
  return goals;
}

/// From the `first` pose on.
void solve_lanes(const ArmNumbers& arm, const PoseBatch& poses, std::size_t first,
                 const PoseAnswers& out) {
  const Goals goals = goals_at(arm, poses, first);
  const AroundAxis around = around_axis(arm, goals.wrist);
  Masks special = goals.bad | around.free, found{}, within{}, singular{};
  Lanes position_m{}, angle_rad{};
  for (int side = 0; side < 2; ++side) {
    const Shoulder shoulder =
        shoulder_at(arm, goals.wrist, around, side == 0 ? around.along : -around.along, nullptr);
    const LaneTriple wrist = shoulder.seen(goals.wrist), lever = shoulder.seen(goals.lever);
    const Axes seen{shoulder.seen(goals.axes.n), shoulder.seen(goals.axes.o),
                    shoulder.seen(goals.axes.a)};
    const InPlane plane = in_plane(arm, around, shoulder, wrist.z, poses.rims.slack);
    special |= plane.reached & plane.free;
    Elbows elbows = elbows_at(arm, plane.rho, all(1));
#pragma GCC unroll 2
    for (int elbow = 0; elbow < 2; ++elbow) {
      const UpperArm upper = upper_arm(arm, wrist, plane, elbows, nullptr);
      const Wrists wrists = wrists_at(
          arm, {upper.in_forearm(seen.n), upper.in_forearm(seen.o), upper.in_forearm(seen.a)},
          ArmQuestion::Task::rotation, poses.rims.in_line, nullptr);
      special |= plane.reached & wrists.free;
      const Lanes miss_m = norm(tool_miss(upper, wrists.turn, lever)), turn = norm(wrists.turn);
      position_m = larger(position_m, plane.reached ? miss_m : all(0));
      angle_rad = larger(angle_rad, plane.reached ? turn : all(0));
      const Masks flagged = plane.reached & singular_at(arm, shoulder, elbows, wrists.factor);
      const Lanes t[6]{shoulder.t1, upper.t2, upper.t3, wrists.t4, wrists.t5, wrists.t6};
      each_wrist(
          arm, t, Masks{}, nullptr,
          [&](int wrist_side, const Lanes(&q)[6], const Lanes& margin)
              __attribute__((always_inline)) {
                const int slot = 4 * side + 2 * elbow + wrist_side;
                for (int i = 0; i < 6; ++i) store(q[i], out.joint[slot][i] + first);
                const std::int64_t bit = std::int64_t{1} << slot;
                found |= plane.reached & bit;
                within |= plane.reached & (margin >= 0) & bit;
                singular |= flagged & bit;
              });
      elbows.psi = -elbows.psi, elbows.sin_psi = -elbows.sin_psi, elbows.y = -elbows.y;
    }
  }
  store(special ? Masks{} + PoseAnswers::kSpecial : found, out.found + first);
  store(within, out.within_limits + first);
  store(singular, out.singular + first);
  store(position_m, out.position_m + first);
  store(angle_rad, out.angle_rad + first);
}

/// The last lanes go over some poses once more; poses that fill no lanes need rules of their own.
void solve_all_poses(const ArmNumbers& arm, const PoseBatch& poses, const PoseAnswers& out) {
  if (poses.count < kLanes) std::fill_n(out.found, poses.count, PoseAnswers::kSpecial);
  for (std::size_t i = 0; i < poses.count && poses.count >= kLanes; i += kLanes) {
    solve_lanes(arm, poses, std::min(i, poses.count - kLanes), out);
  }
}

}  // namespace
}  // namespace armature
