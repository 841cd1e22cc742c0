// SPDX-License-Identifier: Apache-2.0
#include "lamp_geometric.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "armature/kinds/ik/lanes.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature {
namespace {

// Tilt 0: cos(q6) >= 0. Balance 0: cos(q3) >= 0. Elbow 0: q2 <= 0, the paper's.
constexpr std::array<std::string_view, 8> kLabels{"tilt0/balance0/elbow0", "tilt0/balance0/elbow1",
                                                  "tilt0/balance1/elbow0", "tilt0/balance1/elbow1",
                                                  "tilt1/balance0/elbow0", "tilt1/balance0/elbow1",
                                                  "tilt1/balance1/elbow0", "tilt1/balance1/elbow1"};

// Rounding moves a goal on the rim of the workspace by this much, relative to the arm: what lies
// outside by less counts as on the rim, and what lies within kOnRim is the double root itself.
constexpr double kBeyondRim = 1e-12, kOnRim = 1e-14;
// Below this the sine or cosine in det J5 = a1 l sin q2 a3 cos q3 cos q6 counts as zero.
constexpr double kSingular = 1e-6;
// Pointing up or down: below this the heading of a unit direction says nothing.
constexpr double kVertical = 1e-12;

/// wrap_angle for what is at most 3 pi from zero.
double wrapped(double angle) {
  if (angle < -kPi) angle += 2 * kPi;
  if (angle >= kPi) angle -= 2 * kPi;
  return angle >= kPi ? -kPi : angle;
}

/// Step 1 of a tilt: where the lamp points.
struct Tilt {
  int index;
  double q6, sin_q6, cos_q6;
  double psi, sin_psi, cos_psi;  // psi = q1 + q2 + q5, the heading of the lamp's yoke
};
/// Step 2: the balance arm; l is its horizontal reach.
struct Balance {
  int index;
  double q3, sin_q3, cos_q3, l;
};

/// One goal on its way through the solver.
struct Problem {
  const RobotModel& model;
  const LampLengths& arm;
  const IkGoal& goal;
  Eigen::Vector3d direction;  // unit
  const JointVector& seed;
  IkBranches& out;
  /// What the residuals of the branches in `out` need, each at its own place.
  struct Posture {
    double l, height, sin_q6, cos_q6;
  };
  std::array<Posture, 8> posture;
  double shortfall = std::numeric_limits<double>::infinity();  // smallest of all (tilt, balance)
  std::string_view detail{};

  void out_of_reach(double by, std::string_view why) {
    if (by < shortfall) shortfall = by, detail = why;
  }
};

/// The angle between the tool and the goal's rotation.
double rotation_error(const Problem& p, const Eigen::Vector3d& x, double sin_psi, double cos_psi) {
  Eigen::Matrix3d base_R_tool;
  base_R_tool.col(0) = x;
  base_R_tool.col(2) = Eigen::Vector3d{sin_psi, -cos_psi, 0};
  base_R_tool.col(1) = base_R_tool.col(2).cross(x);
  return Eigen::Quaterniond{base_R_tool}.angularDistance(
      std::get<Eigen::Quaterniond>(p.goal.pose.orientation).normalized());
}

/// The angle between the pointing axis and the goal's direction, from both of its measures.
double direction_error(double sine, double cosine) {
  return cosine > 0 && sine < 1e-6 ? sine : std::atan2(sine, cosine);
}

/// Position and direction errors of forward kinematics, in closed form, at the joints of four
/// branches from `first` on.
void measure_four(Problem& p, int first) {
  const int count = std::min(p.out.count - first, 4);
  Lanes q1, q12, heading, l, height, sin_q6, cos_q6;
  for (int i = 0; i < 4; ++i) {
    const auto k = static_cast<std::size_t>(first + std::min(i, count - 1));
    const JointVector& q = p.out.branch[k].q;
    const Problem::Posture& posture = p.posture[k];
    q1[i] = q[0], q12[i] = q[0] + q[1], heading[i] = q[0] + q[1] + q[3];
    l[i] = posture.l, height[i] = posture.height;
    sin_q6[i] = posture.sin_q6, cos_q6[i] = posture.cos_q6;
  }
  const LaneSinCos first_link = sine_and_cosine(q1), forearm = sine_and_cosine(q12),
                   yoke = sine_and_cosine(heading);
  const Lanes r = p.arm.a5 + p.arm.a6 * cos_q6;
  const Eigen::Vector3d& wanted = p.goal.pose.position;
  const LaneTriple off{p.arm.a1 * first_link.cos + l * forearm.cos + r * yoke.cos - wanted.x(),
                       p.arm.a1 * first_link.sin + l * forearm.sin + r * yoke.sin - wanted.y(),
                       height - wanted.z()};
  const LaneTriple x{cos_q6 * yoke.cos, cos_q6 * yoke.sin, sin_q6};
  const LaneTriple u{all(p.direction.x()), all(p.direction.y()), all(p.direction.z())};
  const Lanes away = norm(off), sine = norm(cross(x, u)),
              cosine = x.x * u.x + x.y * u.y + x.z * u.z;
  const bool rotation = std::holds_alternative<Eigen::Quaterniond>(p.goal.pose.orientation);
  for (int i = 0; i < count; ++i) {
    PoseResidual& residual = p.out.branch[static_cast<std::size_t>(first + i)].residual;
    residual.position_m = away[i];
    residual.angle_rad = rotation
                             ? rotation_error(p, {x.x[i], x.y[i], x.z[i]}, yoke.sin[i], yoke.cos[i])
                             : direction_error(sine[i], cosine[i]);
  }
}

/// Leaves out branches that would need a roll: the lamp cannot turn about its pointing axis, but
/// the other tilt may have it.
void drop_rolled(Problem& p) {
  if (std::holds_alternative<Direction>(p.goal.pose.orientation)) return;
  const double most = std::max(p.goal.tolerance.angle_rad, 1e-7);
  int kept = 0;
  for (int i = 0; i < p.out.count; ++i) {
    const IkBranch& branch = p.out.branch[static_cast<std::size_t>(i)];
    if (branch.residual.angle_rad <= most) p.out.branch[static_cast<std::size_t>(kept++)] = branch;
  }
  if (kept < p.out.count) p.out_of_reach(0, "the lamp cannot roll about its pointing axis");
  p.out.count = kept;
}

/// What `unwind` answers, without turning: every joint of the lamp turns freely.
bool keeps_limits(const RobotModel& model, const JointVector& q) {
  constexpr double kTolerance = 1e-9;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const double lower = model.lower()[i] - kTolerance, upper = model.upper()[i] + kTolerance;
    if (q[i] >= lower && q[i] <= upper) continue;
    const double least = q[i] + 2 * kPi * std::ceil((lower - q[i]) / (2 * kPi));
    if (least > upper) return false;
  }
  return true;
}

void add_branch(Problem& p, const Tilt& tilt, const Balance& balance, int elbow, double q1,
                double q2, double sin_q2) {
  p.posture[static_cast<std::size_t>(p.out.count)] = {
      balance.l, p.arm.d + p.arm.a3 * balance.sin_q3 + p.arm.a6 * tilt.sin_q6, tilt.sin_q6,
      tilt.cos_q6};
  IkBranch& branch = p.out.add();
  branch.label = kLabels[static_cast<std::size_t>(4 * tilt.index + 2 * balance.index + elbow)];
  branch.redundancy = 0;
  branch.q.resize(5);
  const double shoulder = wrapped(q1), forearm = wrapped(q2);
  branch.q << shoulder, forearm, balance.q3, wrapped(tilt.psi - shoulder - forearm), tilt.q6;
  branch.singular = std::abs(sin_q2) < kSingular || std::abs(balance.cos_q3) < kSingular ||
                    std::abs(tilt.cos_q6) < kSingular ||
                    std::abs(balance.l) < kSingular * (p.arm.a3 + std::abs(p.arm.a4));
  branch.within_limits = keeps_limits(p.model, branch.q);
}

/// Steps 3 to 5: the two elbows that bring the wrist over the goal.
void solve_elbows(Problem& p, const Tilt& tilt, const Balance& balance) {
  const double r = p.arm.a5 + p.arm.a6 * tilt.cos_q6;
  const double wx = p.goal.pose.position.x() - r * tilt.cos_psi;
  const double wy = p.goal.pose.position.y() - r * tilt.sin_psi;
  const double a1 = p.arm.a1, l = balance.l;
  const double far = a1 + std::abs(l), near = std::abs(a1 - std::abs(l));
  const double D = std::sqrt(wx * wx + wy * wy);
  // The two radicands of the half angle, factored so that nothing cancels.
  double outside = (far - D) * (far + D), inside = (D - near) * (D + near);
  const double rim = far * far;
  if (outside < -kBeyondRim * rim) return p.out_of_reach(D - far, "horizontal distance");
  if (inside < -kBeyondRim * rim) return p.out_of_reach(near - D, "too near the column");
  if (outside < kOnRim * rim) outside = 0;
  if (inside < kOnRim * rim) inside = 0;

  const double bearing =
      D < kBeyondRim * far ? wrap_angle(p.seed[0]) : std::atan2(wy, wx);  // D = 0: q1 free
  if (std::abs(l) < kBeyondRim * far) {  // the forearm points nowhere: q2 free
    const double q2 = wrap_angle(p.seed[1]);
    return add_branch(p, tilt, balance, q2 <= 0 ? 0 : 1, bearing, q2, 0);
  }
  // tan(q2/2) = sqrt(outside/inside) for l > 0; for l < 0 both radicands change places.
  const double up = std::sqrt(l > 0 ? outside : inside),
               along = std::sqrt(l > 0 ? inside : outside);
  const double turn = 2 * std::atan2(up, along);
  const double scale = 4 * a1 * std::abs(l);  // = up^2 + along^2
  const double sin_turn = 2 * up * along / scale, cos_turn = (along * along - up * up) / scale;
  const double lead = D < kBeyondRim * far ? 0 : std::atan2(l * sin_turn, a1 + l * cos_turn);
  add_branch(p, tilt, balance, 0, bearing + lead, -turn, sin_turn);
  add_branch(p, tilt, balance, 1, bearing - lead, turn, sin_turn);
}

/// Pointing straight up or down leaves psi free: the seed's, or the nearest to it that reaches.
double free_heading(const Problem& p, const Balance& balance) {
  const double wanted = wrap_angle(p.seed[0] + p.seed[1] + p.seed[3]);
  const double x = p.goal.pose.position.x(), y = p.goal.pose.position.y();
  const double P = std::hypot(x, y), r = p.arm.a5;
  if (!(P * std::abs(r) > 0)) return wanted;
  const double far = p.arm.a1 + std::abs(balance.l);
  const double near = std::abs(p.arm.a1 - std::abs(balance.l));
  // |w|^2 = P^2 + r^2 - 2 P r cos(psi - bearing) must lie within near^2 and far^2.
  const auto cosine = [&](double reach) {
    return std::clamp((P * P + r * r - reach * reach) / (2 * P * r), -1.0, 1.0);
  };
  const double at_far = std::acos(cosine(far)), at_near = std::acos(cosine(near));
  const double bearing = std::atan2(y, x), offset = wrap_angle(wanted - bearing);
  const double turned =
      std::clamp(std::abs(offset), std::min(at_far, at_near), std::max(at_far, at_near));
  return turned == std::abs(offset) ? wanted : bearing + std::copysign(turned, offset);
}

/// The balance arm, standing upright, still misses the goal's height.
void too_high_or_low(Problem& p, const Tilt& tilt, double sin_q3) {
  const double height = (std::abs(sin_q3) - 1) * p.arm.a3;
  const double r = p.arm.a5 + p.arm.a6 * tilt.cos_q6;
  const double D = std::hypot(p.goal.pose.position.x() - r * tilt.cos_psi,
                              p.goal.pose.position.y() - r * tilt.sin_psi);
  const double horizontal = std::max(D - p.arm.a1 - std::abs(p.arm.a4), 0.0);
  p.out_of_reach(std::hypot(height, horizontal),
                 height > horizontal ? "height" : "horizontal distance");
}

void solve_tilt(Problem& p, Tilt tilt, bool vertical) {
  const double sin_q3 = (p.goal.pose.position.z() - p.arm.d - p.arm.a6 * tilt.sin_q6) / p.arm.a3;
  if (std::abs(sin_q3) > 1 + kBeyondRim) return too_high_or_low(p, tilt, sin_q3);
  const double s3 = std::clamp(sin_q3, -1.0, 1.0);
  const double up = std::asin(s3);
  for (int index = 0; index < 2; ++index) {
    const double c3 = (index == 0 ? 1 : -1) * std::sqrt((1 - s3) * (1 + s3));
    const Balance balance{index, index == 0 ? up : wrapped(kPi - up), s3, c3,
                          p.arm.a3 * c3 + p.arm.a4};
    if (vertical) {
      tilt.psi = free_heading(p, balance);
      tilt.sin_psi = std::sin(tilt.psi), tilt.cos_psi = std::cos(tilt.psi);
    }
    solve_elbows(p, tilt, balance);
  }
}

void solve_all(Problem& p) {
  const auto& u = p.direction;
  const double h = std::sqrt(u.x() * u.x() + u.y() * u.y());
  if (h < kVertical) {  // both tilts are one
    const double up = u.z() > 0 ? 1 : -1;
    return solve_tilt(p, {0, up * kPi / 2, up, 0, 0, 0, 1}, true);
  }
  const double q6 = std::atan2(u.z(), h), psi = std::atan2(u.y(), u.x());
  const double s = u.y() / h, c = u.x() / h;
  solve_tilt(p, {0, q6, u.z(), h, psi, s, c}, false);
  solve_tilt(p,
             {1, wrapped(u.z() >= 0 ? kPi - q6 : -kPi - q6), u.z(), -h, wrapped(psi + kPi), -s, -c},
             false);
}

}  // namespace

Expected<std::unique_ptr<IkSolver>> LampGeometric::make(const RobotModel& model, const Params&) {
  auto lengths = lamp_lengths(model);
  if (!lengths) return tl::unexpected{lengths.error()};
  return std::unique_ptr<IkSolver>{new LampGeometric{model, *lengths}};
}

IkStatus LampGeometric::solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                              IkState&) const {
  out.clear();
  if (const char* why = invalid_input(*model_, goal, seed)) {
    return {IkStatus::Code::invalid_input, 0, why};
  }
  const auto* pointing = std::get_if<Direction>(&goal.pose.orientation);
  const Eigen::Vector3d direction =
      pointing ? pointing->unit.normalized()
               : Eigen::Vector3d{std::get<Eigen::Quaterniond>(goal.pose.orientation).normalized() *
                                 Eigen::Vector3d::UnitX()};
  Problem problem{*model_, lengths_, goal, direction, seed, out};
  solve_all(problem);
  for (int first = 0; first < out.count; first += 4) measure_four(problem, first);
  drop_rolled(problem);
  if (out.count == 0) {
    return {IkStatus::Code::out_of_reach, problem.shortfall, problem.detail};
  }
  const bool any = std::any_of(out.begin(), out.end(), [](auto& b) { return b.within_limits; });
  if (any) return {};
  return {IkStatus::Code::joint_limit, 0, "every branch leaves the joint limits"};
}

}  // namespace armature

ARMATURE_PLUGIN(armature::LampGeometric);
