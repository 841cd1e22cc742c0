// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <utility>

#include "line_search.hpp"
#include "needle_line.hpp"

namespace armature {
namespace {

constexpr double kRoot = 1e-10;  // [rad] larger errors at a change of sign are a jump, not a root

struct Sample {
  double depth = 0, error = 0;
};

/// Follows the roll error of one shoulder and elbow from step to step, and notes the roots. Beyond
/// the rims of reach the error goes on without a jump, so that none next to a rim is missed.
class RootsOfArm {
 public:
  RootsOfArm(const NeedleLine& line, std::size_t arm, RollRoots::Roots& found)
      : line_{&line}, arm_{arm}, found_{&found} {}

  /// On to the next step.
  void follow_to(double depth, const RollErrors& errors) {
    const double last = here_.depth;  // the step before; NaN: there is none
    const bool now = errors.reached[arm_], before = std::exchange(reached_, now);
    if (now != before && !std::isnan(last)) {
      const double inside = now ? depth : last, outside = now ? last : depth;
      approach(inside,
               last_where(inside, outside, [&](double at) { return errors_at(at).reached[arm_]; }));
    } else if (last == line_->least) {
      approach(depth, last);
    } else if (depth == line_->most) {
      approach(last, depth);
    }
    follow({depth, errors.of[arm_]});
  }

 private:
  /// Close to a rim of reach the error may run like a square root, and roots lie close together:
  /// there the depths come in ever smaller distances. So they do at the ends of the range.
  void approach(double inside, double rim) {
    constexpr int kDepths = 5;
    for (int i = 0; i <= kDepths; ++i) {
      const int nearer = inside < rim ? i + 1 : kDepths + 1 - i;
      const double part = nearer > kDepths ? 0 : std::pow(0.25, nearer);
      const double depth = rim + (inside - rim) * part;
      follow({depth, error(depth)});
    }
  }
  void follow(const Sample& next) {
    if (next.depth == here_.depth) return;
    if (next.error == 0) {
      add(next.depth);
    } else if (here_.error * next.error < 0) {
      add(zero(here_, next));
    } else {
      touch(before_, here_, next);
    }
    before_ = here_, here_ = next;
  }
  RollErrors errors_at(double depth) const {
    RollErrors errors;
    line_->kernel.roll_errors(line_->arm, line_->goal.at(depth), errors);
    return errors;
  }
  double error(double depth) const { return errors_at(depth).of[arm_]; }
  double zero(const Sample& a, const Sample& b) const {
    const double last =
        last_where(a.depth, b.depth, [&](double depth) { return error(depth) * a.error > 0; });
    const double next = std::nextafter(last, b.depth);
    return std::abs(error(next)) < std::abs(error(last)) ? next : last;
  }

  /// |error| is least in the middle and has one sign: it may touch zero or cross it twice.
  void touch(const Sample& a, const Sample& middle, const Sample& b) {
    const bool least =
        std::abs(middle.error) < std::abs(a.error) && std::abs(middle.error) < std::abs(b.error);
    if (!least || !(a.error * middle.error > 0)) return;
    const double sign = middle.error > 0 ? -1 : 1;
    const double depth =
        golden_maximum(a.depth, b.depth, [&](double at) { return sign * error(at); });
    const Sample nearest{depth, error(depth)};
    if (nearest.error * middle.error < 0) {
      add(zero(a, nearest));
      add(zero(b, nearest));
    } else {
      add(depth);
    }
  }

  /// Notes a root, unless it is out of reach or a jump through zero.
  void add(double depth) {
    const RollErrors there = errors_at(depth);
    const bool root = there.reached[arm_] && std::abs(there.of[arm_]) <= kRoot;
    if (!root || found_->count == found_->root.size()) return;
    constexpr double kStep = 1e-6;
    const double slope = (error(depth + kStep) - error(depth - kStep)) / (2 * kStep);
    found_->root[found_->count++] = {depth, slope};
  }

  const NeedleLine* line_;
  std::size_t arm_;
  RollRoots::Roots* found_;
  bool reached_ = false;
  // An error of 0 is unlike any other.
  Sample before_, here_{std::numeric_limits<double>::quiet_NaN(), 0};
};

}  // namespace

RollRoots roll_roots(const NeedleLine& line, double reached) {
  RollRoots roots;
  std::array arms{RootsOfArm{line, 0, roots.of[0]}, RootsOfArm{line, 1, roots.of[1]},
                  RootsOfArm{line, 2, roots.of[2]}, RootsOfArm{line, 3, roots.of[3]}};
  const auto follow_to = [&](double depth) {
    RollErrors errors;
    line.kernel.roll_errors(line.arm, line.goal.at(depth), errors);
    for (std::size_t i = 0; i < 4; ++i) {
      arms[i].follow_to(depth, errors);
      if (!errors.reached[i]) continue;
      roots.min_error = std::fmin(roots.min_error, std::abs(errors.of[i]));
    }
  };
  for (int step = 0; step <= NeedleLine::kSteps; ++step) {
    const bool between = step > 0 && line.step(step - 1) < reached && reached < line.step(step);
    if (between) follow_to(reached);
    follow_to(line.step(step));
  }
  return roots;
}

}  // namespace armature
