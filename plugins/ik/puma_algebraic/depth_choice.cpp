// SPDX-License-Identifier: Apache-2.0
#include "depth_choice.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "line_search.hpp"

namespace armature {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Of every branch of a needle line the distance to the joint limits; -infinity where it does not
/// reach.
struct Margins {
  std::array<double, 8> of{-kInfinity, -kInfinity, -kInfinity, -kInfinity,
                           -kInfinity, -kInfinity, -kInfinity, -kInfinity};
  double best = -kInfinity;
  double shortfall = kInfinity;  // [m] of the nearest branch
  std::string_view detail;
};

Margins margins_at(const NeedleTask& task, double depth) {
  FourArms arms;
  task.kernel.solve(task.arm, task.goal.at(depth), arms);
  Margins margins;
  for (std::size_t i = 0; i < 8; ++i) {
    if (!arms.reached[i / 2]) continue;
    margins.of[i] = arms.margin[i % 2][i / 2];
    margins.best = std::max(margins.best, margins.of[i]);
  }
  margins.shortfall = margins.best > -kInfinity ? 0 : arms.shortfall;
  margins.detail = arms.detail;
  return margins;
}

/// Keeps the best of the depths it is told: within limits before reachable before near reach, and
/// the one nearest to the wanted depth among equals.
class DepthChoice {
 public:
  explicit DepthChoice(double wanted) : wanted_{wanted} { best_.shortfall = kInfinity; }

  void consider(double depth, const Margins& margins) {
    const ChosenDepth other{depth, margins.best >= 0, margins.best > -kInfinity, margins.shortfall,
                            margins.detail};
    if (better(other)) best_ = other;
  }
  const ChosenDepth& best() const { return best_; }

 private:
  bool better(const ChosenDepth& other) const {
    if (other.within_limits != best_.within_limits) return other.within_limits;
    if (other.reachable != best_.reachable) return other.reachable;
    if (!other.reachable) return other.shortfall < best_.shortfall;
    return std::abs(other.depth - wanted_) < std::abs(best_.depth - wanted_);
  }
  double wanted_;
  ChosenDepth best_;
};

/// Whether the margins a, b, c of a branch at three depths in a row can rise to 0 between them.
bool may_rise_to_zero(double a, double b, double c) {
  return b > -kInfinity && b >= a && b >= c && b + std::max(b - a, b - c) >= 0;
}

/// Steps that a local maximum between them could lie beyond.
struct Window {
  std::array<Margins, 3> at;
  double from, to;  // [m]
};

/// The maxima of the margins around the middle of a window, and of the reach.
void refine(const NeedleTask& task, const Window& window, DepthChoice& choice) {
  const auto& [before, here, after] = window.at;
  for (std::size_t branch = 0; branch < 8; ++branch) {
    if (!may_rise_to_zero(before.of[branch], here.of[branch], after.of[branch])) continue;
    const auto margin = [&](double depth) { return margins_at(task, depth).of[branch]; };
    const double depth = golden_maximum(window.from, window.to, 0, margin);
    choice.consider(depth, margins_at(task, depth));
  }
  const bool nearest =
      here.shortfall > 0 && here.shortfall <= before.shortfall && here.shortfall <= after.shortfall;
  if (!nearest) return;
  const auto reach = [&](double depth) { return -margins_at(task, depth).shortfall; };
  const double depth = golden_maximum(window.from, window.to, 0, reach);
  choice.consider(depth, margins_at(task, depth));
}

void refine_all(const NeedleTask& task, DepthChoice& choice) {
  const Margins beyond;  // of the range
  Window window{{beyond, beyond, margins_at(task, task.depth_at(0))}, 0, 0};
  for (int step = 0; step <= NeedleTask::kSteps; ++step) {
    window.at[0] = window.at[1];
    window.at[1] = window.at[2];
    window.at[2] = step < NeedleTask::kSteps ? margins_at(task, task.depth_at(step + 1)) : beyond;
    window.from = task.depth_at(std::max(step - 1, 0));
    window.to = task.depth_at(std::min(step + 1, NeedleTask::kSteps));
    refine(task, window, choice);
  }
}

}  // namespace

ChosenDepth choose_depth(const NeedleTask& task, double wanted) {
  DepthChoice choice{wanted};
  for (int step = 0; step <= NeedleTask::kSteps; ++step) {
    choice.consider(task.depth_at(step), margins_at(task, task.depth_at(step)));
  }
  if (!choice.best().within_limits) refine_all(task, choice);
  return choice.best();
}

}  // namespace armature
