// SPDX-License-Identifier: Apache-2.0
#include "roll_roots.hpp"

#include <algorithm>
#include <cmath>

#include "line_search.hpp"

namespace armature {
namespace {

constexpr double kRoot = 1e-10;  // [rad] larger errors at a change of sign are a jump, not a root

/// Of each shoulder and elbow at a depth; NaN where it does not reach.
struct RollErrors {
  double of[4]{};
  double shortfall = 0;  // [m] when none reaches
  std::string_view detail;
};

RollErrors errors_at(const NeedleTask& task, double depth) {
  FourArms arms;
  RollErrors errors;
  task.kernel.roll_errors(task.arm, task.goal.at(depth), arms, errors.of);
  for (const bool reached : arms.reached) {
    if (reached) return errors;
  }
  errors.shortfall = arms.shortfall;
  errors.detail = arms.detail;
  return errors;
}

/// Keeps what a caller is told when there is no root.
void note(const RollErrors& errors, RollRoots& roots) {
  if (errors.shortfall < roots.shortfall) {
    roots.shortfall = errors.shortfall;
    roots.detail = errors.detail;
  }
  for (const double error : errors.of) {
    if (std::abs(error) < roots.min_error) roots.min_error = std::abs(error);
  }
}

/// Follows the roll error of one shoulder and elbow along a stretch of depths that it reaches, and
/// notes the roots.
class RootsOfArm {
 public:
  RootsOfArm(const NeedleTask& task, std::size_t arm, RollRoots::Depths& found)
      : task_{&task}, arm_{arm}, found_{&found} {}

  /// A stretch begins at `rim`; the next depth to follow is `inside`. Close to a rim the error may
  /// run like a square root: there the depths come in ever smaller distances.
  void begin(double rim, double inside) {
    count_ = 0;
    follow(rim);
    for (int i = kApproach; i > 0; --i) follow(rim + (inside - rim) * std::pow(0.25, i));
  }
  void follow(double depth) {
    const Sample next{depth, error(depth)};
    if (std::isnan(next.error)) return;
    if (next.error == 0) {
      add(next.depth);
    } else if (count_ > 0 && here_.error * next.error < 0) {
      add(zero(here_, next));
    } else if (count_ > 1) {
      touch(before_, here_, next);
    }
    before_ = here_, here_ = next;
    ++count_;
  }
  void end(double inside, double rim) {
    for (int i = 1; i <= kApproach; ++i) follow(rim + (inside - rim) * std::pow(0.25, i));
    follow(rim);
    count_ = 0;
  }
  /// The last depth from `inside` towards `outside` that is reached.
  double rim(double inside, double outside) const {
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (inside + outside);
      (std::isnan(error(middle)) ? outside : inside) = middle;
    }
    return inside;
  }

 private:
  static constexpr int kApproach = 5;
  struct Sample {
    double depth = 0, error = 0;
  };

  double error(double depth) const { return errors_at(*task_, depth).of[arm_]; }
  double zero(const Sample& a, const Sample& b) const {
    return bracketed_zero(a.depth, a.error, b.depth, b.error,
                          [this](double depth) { return error(depth); });
  }

  /// |error| is least in the middle and has one sign: it may touch zero or cross it twice.
  void touch(const Sample& a, const Sample& middle, const Sample& b) {
    const bool least =
        std::abs(middle.error) < std::abs(a.error) && std::abs(middle.error) < std::abs(b.error);
    if (!least || a.error * middle.error <= 0) return;
    const double sign = middle.error > 0 ? -1 : 1;
    const auto towards_zero = [&](double depth) { return sign * error(depth); };
    const double depth = golden_maximum(a.depth, b.depth, 0, towards_zero);
    const Sample nearest{depth, error(depth)};
    if (nearest.error * middle.error < 0) {
      add(zero(a, nearest));
      add(zero(nearest, b));
    } else {
      add(depth);
    }
  }

  /// Notes a root, unless it is a jump through zero.
  void add(double depth) {
    if (found_->count == RollRoots::kMax || !(std::abs(error(depth)) <= kRoot)) return;
    constexpr double kStep = 1e-6;
    const double slope = (error(depth + kStep) - error(depth - kStep)) / (2 * kStep);
    found_->root[static_cast<std::size_t>(found_->count++)] = {depth,
                                                               std::isnan(slope) ? 0 : slope};
  }

  const NeedleTask* task_;
  std::size_t arm_;
  RollRoots::Depths* found_;
  Sample before_, here_;
  int count_ = 0;
};

/// Feeds one shoulder and elbow with what lies between two steps.
void search_arm(const NeedleTask& task, int step, bool before, bool here, RootsOfArm& arm) {
  const double depth = task.depth_at(step), last = task.depth_at(step - 1);
  if (before && here) {
    if (step == 1) arm.begin(last, depth);  // the ends of the range are rims, too
    if (step == NeedleTask::kSteps) {
      arm.end(last, depth);
    } else {
      arm.follow(depth);
    }
  } else if (here) {
    arm.begin(arm.rim(depth, last), depth);
    arm.follow(depth);
  } else if (before) {
    if (step == 1) arm.begin(last, arm.rim(last, depth));
    arm.end(last, arm.rim(last, depth));
  }
}

/// A stretch that lies between two steps, around `inside`.
void search_between_steps(double from, double inside, double to, RootsOfArm& arm) {
  arm.begin(arm.rim(inside, from), inside);
  arm.follow(inside);
  arm.end(inside, arm.rim(inside, to));
}

}  // namespace

RollRoots roll_roots(const NeedleTask& task) {
  RollRoots roots;
  std::array<RootsOfArm, 4> arms{RootsOfArm{task, 0, roots.of[0]}, RootsOfArm{task, 1, roots.of[1]},
                                 RootsOfArm{task, 2, roots.of[2]},
                                 RootsOfArm{task, 3, roots.of[3]}};
  std::array<RollErrors, 3> window;  // two steps before, one before, this one
  for (int step = 0; step <= NeedleTask::kSteps; ++step) {
    window = {window[1], window[2], errors_at(task, task.depth_at(step))};
    note(window[2], roots);
    for (std::size_t i = 0; i < 4 && step > 0; ++i) {
      search_arm(task, step, !std::isnan(window[1].of[i]), !std::isnan(window[2].of[i]), arms[i]);
    }
    const double shortfall = window[1].shortfall;
    if (step < 2 ||
        !(shortfall > 0 && shortfall <= window[0].shortfall && shortfall <= window[2].shortfall))
      continue;
    const double from = task.depth_at(step - 2), to = task.depth_at(step);
    const double depth =
        golden_maximum(from, to, 0, [&](double at) { return -errors_at(task, at).shortfall; });
    const RollErrors nearest = errors_at(task, depth);
    note(nearest, roots);
    for (std::size_t i = 0; i < 4; ++i) {
      if (!std::isnan(nearest.of[i])) search_between_steps(from, depth, to, arms[i]);
    }
  }
  return roots;
}

}  // namespace armature
