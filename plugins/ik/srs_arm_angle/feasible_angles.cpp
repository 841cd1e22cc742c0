// SPDX-License-Identifier: Apache-2.0
#include "feasible_angles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace armature {
namespace {

constexpr double kPi = std::numbers::pi;
// Less than the kind's, so that what is feasible here is within limits there [rad].
constexpr double kTolerance = 0.9e-9;

/// The limits of a turn, asked by sine and cosine.
class TurnRange {
 public:
  TurnRange(double middle, double half)
      : middle_rad_{middle},
        half_{half + kTolerance},
        middle_{SinCos::of(middle)},
        cos_half_{half_ < kPi ? std::cos(half_) : -1} {}

  bool open() const { return half_ >= kPi; }
  double lower() const { return middle_rad_ - half_ + kTolerance; }
  double upper() const { return middle_rad_ + half_ - kTolerance; }
  /// Whether the angle with sine y / r and cosine x / r is inside.
  bool holds(double y, double x, double r) const {
    if (open()) return true;
    const double along = x * middle_.cos + y * middle_.sin;
    constexpr double kNarrow = 0.1;  // the cosine tells nothing of small angles
    if (half_ > kNarrow) return along >= cos_half_ * r;
    const double across = y * middle_.cos - x * middle_.sin;
    return std::abs(std::atan2(across, along)) <= half_;
  }

 private:
  double middle_rad_, half_;
  SinCos middle_;
  double cos_half_;
};

/// Roots of the limits and where the hinge is at its ends, where turns may jump.
struct Events {
  static constexpr int kCapacity = 36;
  std::array<double, kCapacity> at;
  int count = 0;

  void add(double x) {
    if (count < kCapacity) at[static_cast<std::size_t>(count++)] = x;
  }
  /// Of a sin x + b cos x + c = 0; where that only just has none, the place nearest to one.
  void add_roots(double a, double b, double c) {
    constexpr double kJustNone = 1e-9;
    const double r = std::sqrt(a * a + b * b);
    if (!(r > 0) || std::abs(c) > r * (1 + kJustNone)) return;
    const double middle = std::atan2(a, b);
    const double away = std::atan2(std::sqrt(std::max((r - c) * (r + c), 0.0)), -c);
    add(middle - away);
    add(middle + away);
  }
};

/// A shoulder or wrist and its limits.
class LimitedBall {
 public:
  LimitedBall(const SrsArm& arm, const ArmBall& ball)
      : arm_{arm},
        ball_{ball},
        a_{arm.middle[ball.first] - ball.shift_a, arm.half[ball.first]},
        b_{arm.middle[ball.first + 1], arm.half[ball.first + 1]},
        c_{arm.middle[ball.first + 2] - ball.shift_c, arm.half[ball.first + 2]} {}

  /// Arm angles, rising from -pi to pi, between which nothing changes.
  Events events() const;
  /// Whether the limits are kept, as found and flipped; in line by some sharing of the turns.
  std::array<bool, 2> keeps_at(double arm_angle) const;
  /// The same on the way past an arm angle, where turns follow from those before.
  std::array<bool, 2> keeps_around(double arm_angle) const {
    return in_line_everywhere() ? keeps_at(arm_angle) : keeps_turning(turned_to(arm_angle));
  }

 private:
  /// What the angles are arctangents of, and the sine of b.
  struct Turned {
    double m13, m23, m31, m32, m33, sin_b;
  };
  Turned turned_to(double arm_angle) const;
  std::array<bool, 2> keeps_turning(const Turned& m) const;
  void add_turn_events(Events& events) const;
  void add_events_in_line(Events& events) const;
  bool in_line_everywhere() const {
    const auto& [p, q] = ball_.ball;
    return std::abs(p.sin) + std::abs(q.sin) < ball_.in_line;
  }

  const SrsArm& arm_;
  const ArmBall& ball_;
  TurnRange a_, b_, c_;
};

/// a and c of the ball joint are arctangents of (M23, M13) and (M32, -M31), b is arccos M33:
///   M13 = cos p sin q cos x + sin p cos q    M23 = sin q sin x
///   M31 = -sin p cos q cos x - cos p sin q   M32 = sin p sin x
///   M33 = cos p cos q - sin p sin q cos x
void LimitedBall::add_turn_events(Events& events) const {
  const auto& [p, q] = ball_.ball;
  if (!a_.open()) {
    for (const SinCos& end : {SinCos::of(a_.lower()), SinCos::of(a_.upper())}) {
      events.add_roots(q.sin * end.cos, -p.cos * q.sin * end.sin, -p.sin * q.cos * end.sin);
    }
  }
  if (!b_.open()) {
    for (const double end : {std::cos(b_.lower()), std::cos(b_.upper())}) {
      events.add_roots(0, -p.sin * q.sin, p.cos * q.cos - end);
    }
  }
  if (!c_.open()) {
    for (const SinCos& end : {SinCos::of(c_.lower()), SinCos::of(c_.upper())}) {
      events.add_roots(p.sin * end.cos, -p.sin * q.cos * end.sin, -p.cos * q.sin * end.sin);
    }
  }
}

/// +-x is the sum or the difference of a and c, each of which is anywhere in its range.
void LimitedBall::add_events_in_line(Events& events) const {
  if (a_.open() || c_.open()) return;
  for (const double a : {a_.lower(), a_.upper()}) {
    for (const double c : {c_.lower(), c_.upper()}) {
      for (const double x : {a + c, a - c}) {
        events.add(x);
        events.add(-x);
      }
    }
  }
}

Events LimitedBall::events() const {
  Events events;
  events.add(0);
  events.add(kPi);
  if (in_line_everywhere()) {
    add_events_in_line(events);
  } else {
    add_turn_events(events);
  }
  for (int i = 0; i < events.count; ++i) {
    double& x = events.at[static_cast<std::size_t>(i)];
    x = wrap_angle(ball_.x_at(x));  // from x to the arm angle it is the same way as back
  }
  events.add(-kPi);
  events.add(kPi);
  std::sort(events.at.begin(), events.at.begin() + events.count);
  return events;
}

LimitedBall::Turned LimitedBall::turned_to(double arm_angle) const {
  const SinCos x = SinCos::of(ball_.x_at(arm_angle));
  const auto& [p, q] = ball_.ball;
  Turned m;
  m.m13 = p.cos * q.sin * x.cos + p.sin * q.cos;
  m.m23 = q.sin * x.sin;
  m.m31 = -p.sin * q.cos * x.cos - p.cos * q.sin;
  m.m32 = p.sin * x.sin;
  m.m33 = p.cos * q.cos - p.sin * q.sin * x.cos;
  m.sin_b = std::sqrt(m.m13 * m.m13 + m.m23 * m.m23);
  return m;
}

std::array<bool, 2> LimitedBall::keeps_turning(const Turned& m) const {
  const double s = m.sin_b;
  return {b_.holds(s, m.m33, 1) && a_.holds(m.m23, m.m13, s) && c_.holds(m.m32, -m.m31, s),
          b_.holds(-s, m.m33, 1) && a_.holds(-m.m23, -m.m13, s) && c_.holds(-m.m32, m.m31, s)};
}

std::array<bool, 2> LimitedBall::keeps_at(double arm_angle) const {
  const Turned m = turned_to(arm_angle);
  if (m.sin_b >= ball_.in_line) return keeps_turning(m);
  const bool kept = turns_of(arm_, ball_, ball_.angles_at(arm_angle))[0].within_limits;
  return {kept, kept};
}

/// `piece` begins where the last span ends, or later.
void join(const Span& piece, Spans& spans) {
  if (spans.count > 0) {
    Span& last = spans.span[static_cast<std::size_t>(spans.count - 1)];
    if (piece.lower <= last.upper) {
      last.upper = std::max(last.upper, piece.upper);
      return;
    }
  }
  spans.add(piece);
}

}  // namespace

std::array<Spans, 2> feasible_spans(const SrsArm& arm, const ArmBall& ball) {
  const LimitedBall limited{arm, ball};
  const Events events = limited.events();
  std::array<Spans, 2> spans;
  const auto note = [&](const Span& piece, const std::array<bool, 2>& kept) {
    for (std::size_t flip = 0; flip < 2; ++flip) {
      if (kept[flip]) join(piece, spans[flip]);
    }
  };
  for (std::size_t i = 0; i < static_cast<std::size_t>(events.count); ++i) {
    const double here = events.at[i];
    note({here, here}, limited.keeps_at(here));
    if (here == kPi) break;
    const double next = events.at[i + 1];
    if (next > here) note({here, next}, limited.keeps_around(here + 0.5 * (next - here)));
  }
  return spans;
}

Spans common_spans(const SrsArm& arm, const ArmCircle& circle, const Flips& flips,
                   const Spans& shoulder, const Spans& wrist) {
  constexpr double kTouching = 1e-7;  // a root of two limits at once is known to the root of 1e-16
  const auto both_keep = [&](double arm_angle) {
    return LimitedBall{arm, circle.shoulder}.keeps_at(arm_angle)[flips.shoulder] &&
           LimitedBall{arm, circle.wrist}.keeps_at(arm_angle)[flips.wrist];
  };
  Spans common;
  for (const Span *a = shoulder.begin(), *b = wrist.begin();
       a != shoulder.end() && b != wrist.end();) {
    const double lower = std::max(a->lower, b->lower), upper = std::min(a->upper, b->upper);
    if (lower <= upper) {
      join({lower, upper}, common);
    } else if (lower - upper < kTouching) {
      for (const double at : {upper, 0.5 * (lower + upper), lower}) {
        if (both_keep(at)) join({at, at}, common);
      }
    }
    (a->upper < b->upper ? a : b)++;
  }
  return common;
}

}  // namespace armature
