// SPDX-License-Identifier: Apache-2.0
#include "knot_times.hpp"

#include <algorithm>
#include <numeric>

#include "armature/kinds/trajectory/time_law.hpp"

namespace armature::trajectory::cubic_spline {
namespace {

/// Shares of the whole from intervals of any size, none next to nothing.
std::vector<double> shares(std::vector<double> interval) {
  constexpr double kMin = 1e-3;  // of the mean
  const double mean =
      std::accumulate(interval.begin(), interval.end(), 0.0) / static_cast<double>(interval.size());
  double total = 0;
  for (double& h : interval) total += h = std::max(h, mean > 0 ? kMin * mean : 1.0);
  std::vector<double> share{0};
  for (const double h : interval) share.push_back(share.back() + h / total);
  share.back() = 1;
  return share;
}

std::vector<double> intervals(const std::vector<double>& share) {
  std::vector<double> interval;
  for (std::size_t i = 1; i < share.size(); ++i) interval.push_back(share[i] - share[i - 1]);
  return interval;
}

std::vector<double> even(const Leg& leg, const JointVector& max_velocity) {
  const auto& q = leg.curve.waypoints();
  std::vector<double> interval;
  for (std::size_t i = 1; i < q.size(); ++i) {
    interval.push_back((q[i] - q[i - 1]).cwiseAbs().cwiseQuotient(max_velocity).maxCoeff());
  }
  return shares(std::move(interval));
}

std::vector<double> eased(const Leg& leg) {
  const TimeLaw law{1};
  std::vector<double> share;
  for (const double s : leg.curve.s()) share.push_back(law.time_at(s));
  return shares(intervals(share));
}

struct Choice {
  std::vector<double> share;
  double need;
};

/// One interval after the other longer, or shorter, as long as that helps.
Choice improved(Choice best, int tries, const KnotTimesNeed& need) {
  constexpr double kFirstStep = 0.25, kLastStep = 1e-3;
  for (double step = kFirstStep; step > kLastStep && tries > 0;) {
    bool better = false;
    for (std::size_t i = 0; i + 1 < best.share.size(); ++i) {
      for (const double factor : {1 + step, 1 / (1 + step)}) {
        if (tries-- <= 0) return best;
        std::vector<double> interval = intervals(best.share);
        interval[i] *= factor;
        Choice other{shares(std::move(interval)), 0};
        other.need = need(other.share);
        if (!(other.need < best.need)) continue;
        best = std::move(other);
        better = true;
        break;
      }
    }
    if (!better) step /= 2;
  }
  return best;
}

}  // namespace

std::vector<double> best_knot_times(const Leg& leg, const TrajectoryRequest& request, int tries,
                                    const KnotTimesNeed& need) {
  Choice best{even(leg, request.max_velocity), 0};
  if (!leg.moves) return best.share;
  best.need = need(best.share);
  Choice other{eased(leg), 0};
  other.need = need(other.share);
  if (other.need < best.need) best = std::move(other);
  return improved(std::move(best), tries, need).share;
}

}  // namespace armature::trajectory::cubic_spline
