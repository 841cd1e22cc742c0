// SPDX-License-Identifier: Apache-2.0
// What arm angles cost, and the derivative of that; see triangles_body.hpp.
#pragma once

#include "triangles_body.hpp"

namespace armature::ik::srs_arm_angle {
namespace {

/// A number that depends on the arm angle, and its derivative.
struct Level {
  Lanes value, slope;

  friend Level operator+(const Level& a, const Level& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  friend Level operator-(const Level& a, const Level& b) {
    return {a.value - b.value, a.slope - b.slope};
  }
  friend Level operator*(const Lanes& factor, const Level& a) {
    return {factor * a.value, factor * a.slope};
  }
  friend Level operator*(const Level& a, const Level& b) {
    return {a.value * b.value, a.value * b.slope + a.slope * b.value};
  }
};
inline Level pick(const Masks& which, const Level& a, const Level& b) {
  return {which ? a.value : b.value, which ? a.slope : b.slope};
}
inline Level reciprocal(const Level& a) {
  const Lanes inverse = 1 / a.value;
  return {inverse, -(a.slope * inverse * inverse)};
}

/// a, b and c, and how fast they turn with the arm angle: its turn, about the axis of x seen from
/// behind Ry(q), is shared out among the three axes. Finite at sin b = 0.
struct Motion {
  Angles angles;
  Lanes a, b, c;
};
inline Motion motion_at(const Triangles& t, const LaneSinCos& arm_angle, double collinear) {
  constexpr double kMinSine = 1e-12;
  const Angles angles = angles_at(t, arm_angle, collinear);
  const Lanes sine = larger(angles.b.sin, all(kMinSine)), most = all(1 / kMinSine);
  const Lanes inverse = angles.collinear ? most : smaller(angles.inverse_sine, most);
  const Lanes q_sin = t.direction * t.q.sin, along = q_sin * angles.c.cos;
  return {angles, along * inverse, -(q_sin * angles.c.sin),
          (sine * (t.direction * t.q.cos) - angles.b.cos * along) * inverse};
}

/// sin(b)^2, and the square of sin(b) (a', b', c').
struct Spread {
  Level sine2, rates2;
};
Spread spread_of(const Triangles& t, const Motion& m) {
  const auto& [a, b, c, collinear, inverse] = m.angles;
  const Lanes q_sin = t.direction * t.q.sin, q_cos = t.direction * t.q.cos;
  const Level sine{b.sin, b.cos * m.b}, along = q_sin * Level{c.cos, -(c.sin * m.c)};
  const Level across = q_sin * (sine * Level{c.sin, c.cos * m.c});
  const Level last = q_cos * sine - Level{b.cos, -(b.sin * m.b)} * along;
  return {sine * sine, along * along + across * across + last * last};
}

/// What the costs of all branches at an arm angle have in common.
Level common_cost(const Aim& aim, const Spread& shoulder, const Spread& wrist) {
  constexpr double kSingularWeight = 0.02, kSoft = 1e-3;
  if (aim.objective == Objective::singularity) {
    return all(-1) * (wrist.sine2 * shoulder.rates2 + shoulder.sine2 * wrist.rates2);
  }
  const Level soft{all(kSoft), all(0)};
  return all(kSingularWeight) *
         (reciprocal(shoulder.sine2 + soft) + reciprocal(wrist.sine2 + soft));
}
/// Of the distance from the last arm angle, where one is remembered and the objective asks for it.
Level distance_cost(const Aim& aim, const Lanes& arm_angle) {
  constexpr double kLastWeight = 0.1;
  if (aim.objective != Objective::balanced || !aim.remembers) return {all(0), all(0)};
  const Lanes distance = near_zero(arm_angle - aim.last);
  return all(kLastWeight) * Level{distance * distance, 2 * distance};
}

/// u^2 / (1 - u^2) of three joints, u the distance from the middle of the range over half of it; by
/// one division.
struct JointCosts {
  Level a, b, c;
};
inline JointCosts joint_costs(const Level& a, const Level& b, const Level& c) {
  // At the limit, and as far beyond as rounding is.
  const Lanes least = all(1e-9);
  const auto room = [&](const Level& u) { return larger(1 - u.value * u.value, least); };
  const Lanes a_room = room(a), b_room = room(b), c_room = room(c);
  const Lanes a_b = a_room * b_room, inverse = 1 / (a_b * c_room), of_both = inverse * c_room;
  const auto cost = [](const Level& u, const Lanes& over) {
    return Level{u.value * u.value * over, (u.value + u.value) * (over * over) * u.slope};
  };
  return {cost(a, b_room * of_both), cost(b, a_room * of_both), cost(c, a_b * inverse)};
}

/// The costs of limits of a shoulder (`first` is 0) or a wrist (4), by elbow and flip.
inline void set_limit_costs(const ArmNumbers& arm, const Triangle& triangle, int first,
                            const Motion& m, Level (&cost)[2][2]) {
  const auto from_middle = [&](int i, const Lanes& angle, double shift) {
    return near_zero(angle + (shift - arm.middle[first + i]));
  };
  const auto& angles = m.angles;
  const Lanes a = from_middle(0, angle_of(angles.a), triangle.shift_a_rad);
  const Lanes b = angle_of(angles.b);
  const Lanes c = from_middle(2, angle_of(angles.c), triangle.shift_c_rad);
  const Lanes weight[3]{all(arm.weight[first]), all(arm.weight[first + 1]),
                        all(arm.weight[first + 2])};
  const JointCosts by_flip[2]{
      joint_costs(weight[0] * Level{a, m.a}, weight[1] * Level{from_middle(1, b, 0), m.b},
                  weight[2] * Level{c, m.c}),
      joint_costs(weight[0] * Level{half_turned(a), m.a},
                  weight[1] * Level{from_middle(1, -b, 0), -m.b},
                  weight[2] * Level{half_turned(c), m.c})};
  const bool is_wrist = first != 0, collinear = any(angles.collinear);
  for (int elbow = 0; elbow < 2; ++elbow) {  // elbow 1 turns the wrist's a, the shoulder's c
    for (int flip = 0; flip < 2; ++flip) {
      const int other = elbow ^ flip;
      cost[elbow][flip] =
          by_flip[is_wrist ? other : flip].a + by_flip[flip].b + by_flip[is_wrist ? flip : other].c;
      if (!collinear) continue;
      // Both solutions are one, and elbow 1 has c half a turn on.
      cost[elbow][flip] =
          pick(angles.collinear, by_flip[0].a + by_flip[0].b + by_flip[elbow].c, cost[elbow][flip]);
    }
  }
}

/// The costs of all branches at four arm angles of elbow 0.
struct Costs {
  Level shoulder[2][2], wrist[2][2];  // by elbow and flip
  Level other[2];                     // by elbow

  Level of(int branch) const {
    const int elbow = branch / 2 % 2;
    return other[elbow] + shoulder[elbow][branch / 4] + wrist[elbow][branch % 2];
  }
  /// Each lane's branch by itself.
  Level of(const Masks& number) const {
    const Masks s = -(number >> 2), e = -((number >> 1) & 1), w = -(number & 1);
    const auto one = [&](const Level(&by)[2][2], const Masks& flip) {
      return pick(e, pick(flip, by[1][1], by[1][0]), pick(flip, by[0][1], by[0][0]));
    };
    return pick(e, other[1], other[0]) + one(shoulder, s) + one(wrist, w);
  }
};
class CostFunction {
 public:
  CostFunction(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim)
      : arm_{arm}, goal_{goal}, aim_{aim}, shoulder_{goal.shoulder}, wrist_{goal.wrist} {}

  Costs at(const Lanes& arm_angle) const {
    const LaneSinCos turn = sine_and_cosine(arm_angle);
    Costs costs{};
    const Motion shoulder = motion_at(shoulder_, turn, goal_.collinear);
    set_limit_costs(arm_, goal_.shoulder, 0, shoulder, costs.shoulder);
    const Motion wrist = motion_at(wrist_, turn, goal_.collinear);
    set_limit_costs(arm_, goal_.wrist, 4, wrist, costs.wrist);
    if (aim_.objective == Objective::singularity) costs = {};
    if (aim_.objective != Objective::limits) {
      const Level common =
          common_cost(aim_, spread_of(shoulder_, shoulder), spread_of(wrist_, wrist));
      costs.other[0] = common + distance_cost(aim_, arm_angle);
      costs.other[1] = common + distance_cost(aim_, arm_angle + kPi);
    }
    return costs;
  }
  /// Of branches, each at an arm angle of its own.
  Level at(const Lanes& arm_angle, const Masks& branch) const {
    const Masks elbow = -((branch >> 1) & 1);
    return at(elbow ? arm_angle - kPi : arm_angle).of(branch);
  }

 private:
  const ArmNumbers& arm_;
  const SrsGoal& goal_;
  const Aim& aim_;
  Triangles shoulder_, wrist_;
};

/// A lane for each of up to four from a list; the last one stands for those that lack.
template <class Get>
inline Lanes gather(int count, const Get& get) {
  const auto one = [&](int i) { return static_cast<double>(get(i < count ? i : count - 1)); };
  return Lanes{one(0), one(1), one(2), one(3)};
}
template <class Get>
inline Masks gather_numbers(int count, const Get& get) {
  return __builtin_convertvector(gather(count, get), Masks);
}

[[gnu::flatten]] void costs(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim, int count,
                            Node* nodes) {
  const CostFunction cost{arm, goal, aim};
  for (; count > 0; count -= kLanes, nodes += kLanes) {
    const Level level = cost.at(gather(count, [&](int i) { return nodes[i].at; }),
                                gather_numbers(count, [&](int i) { return nodes[i].branch; }));
    for (int i = 0; i < kLanes && i < count; ++i) {
      nodes[i].value = level.value[i];
      nodes[i].slope = level.slope[i];
    }
  }
}

/// Between two nodes there is a minimum when the left one falls and the right one rises or is
/// higher by more than rounding, or when the right one rises and the left one is higher.
inline Masks valleys_between(const Level& left, const Level& right) {
  const Lanes climb = right.value - left.value, noise = 1e-12 * magnitude(left.value);
  return ((left.slope < 0) & ((right.slope >= 0) | (climb > noise))) |
         ((right.slope > 0) & ((left.slope <= 0) | (-climb > noise)));
}
/// Marks the valleys between place `i` - 1 and place `i` + 3.
void mark_valleys(const Level& here, int i, const double* value, const double* slope,
                  std::uint64_t* valley) {
  const auto shifted = [&](const Lanes& now, const double* all_values) {
    const Lanes before = i == 0 ? now : load(all_values + i - kLanes);
    return __builtin_shufflevector(before, now, 3, 4, 5, 6);
  };
  const Level left{shifted(here.value, value), shifted(here.slope, slope)};
  const std::uint64_t bits = bits_of(valleys_between(left, here));
  if (i % 64 != 0) {
    valley[i / 64] |= bits << (i % 64 - 1);
    return;
  }
  valley[i / 64] = bits >> 1;
  if (i > 0) valley[i / 64 - 1] |= bits << 63;
}

[[gnu::flatten]] void costs_all_round(const ArmNumbers& arm, const SrsGoal& goal, const Aim& aim,
                                      CostTable& table) {
  const CostFunction cost{arm, goal, aim};
  for (int i = table.count; i % kLanes != 0; ++i) table.place[i] = kPi;
  for (int i = 0; i < table.count; i += kLanes) {
    const Costs found = cost.at(load(table.place + i));
#pragma GCC unroll 8
    for (int branch = 0; branch < 8; ++branch) {
      double *value = table.value[branch], *slope = table.slope[branch];
      Level level = found.of(branch);
      if (i + kLanes >= table.count) {
        // At pi the arm is where it is at -pi: rounding must not lose a valley there.
        const Masks at_pi = load(table.place + i) == all(kPi);
        level = pick(at_pi, Level{all(value[0]), all(slope[0])}, level);
      }
      mark_valleys(level, i, value, slope, table.valley[branch]);
      store(level.value, value + i);
      store(level.slope, slope + i);
    }
  }
}

}  // namespace
}  // namespace armature::ik::srs_arm_angle
