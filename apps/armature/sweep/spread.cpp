// SPDX-License-Identifier: Apache-2.0
#include "sweep/spread.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "armature/runtime/deployment_file/goals.hpp"
#include "bench/statistics.hpp"

namespace armature::sweep {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kTwoSided95 = 1.959963984540054;  // of a normal distribution

double statistic_of(const Spread& spread, const SweepGoal& goal) {
  switch (goal.statistic) {
    case SweepGoal::Statistic::median: return spread.median();
    case SweepGoal::Statistic::p95: return spread.p95();
    case SweepGoal::Statistic::max: return spread.max();
    case SweepGoal::Statistic::rms: return spread.rms();
    case SweepGoal::Statistic::share: break;
  }
  return spread.share_at_most(goal.share_of);
}

/// Whether a figure is of that metric, or of one component of several that tell it.
bool is_of(const std::string& figure, const std::string& metric) {
  return figure == metric || figure.ends_with('.' + metric);
}

JudgedSweepGoal judged(const SweepGoal& goal, const Spread& spread) {
  JudgedSweepGoal result{.goal = goal, .value = std::nan("")};
  result.goal.metric = spread.figure;
  if (spread.values.empty()) {
    result.applies = spread.runs() > 0;
    if (result.applies) result.fault = "no run measured it";
    return result;
  }
  result.value = statistic_of(spread, goal);
  if (spread.unmeasured > 0 && goal.statistic != SweepGoal::Statistic::share) {
    result.fault =
        fmt::format("{} of {} runs did not measure it", spread.unmeasured, spread.runs());
  } else if (goal.at_least && result.value < *goal.at_least) {
    result.fault = fmt::format("at least {:g}", *goal.at_least);
  } else if (goal.at_most && result.value > *goal.at_most) {
    result.fault = fmt::format("at most {:g}", *goal.at_most);
  }
  if (!result.fault.empty() && goal.statistic == SweepGoal::Statistic::share) {
    const auto hits =
        static_cast<std::size_t>(std::lround(result.value * static_cast<double>(spread.runs())));
    const Bounds interval = share_interval(hits, spread.runs());
    const bool may_be_met =
        interval.high >= goal.at_least.value_or(0) && interval.low <= goal.at_most.value_or(1);
    if (may_be_met) {
      result.fault += fmt::format("; {} runs are too few to tell, it is between {:.3g} and {:.3g}",
                                  spread.runs(), interval.low, interval.high);
    }
  }
  return result;
}

bool does_not_apply(const Json& report, const std::string& figure) {
  const auto reasons = report.find("does_not_apply");
  return reasons != report.end() && reasons->contains(figure);
}

/// The figures that are numbers, in the order in which reports tell them.
std::vector<Spread> figures_of(const std::vector<SeedReport>& reports) {
  std::vector<Spread> figures;
  for (const auto& [seed, report] : reports) {
    for (const auto& [key, value] : report->items()) {
      if (!value.is_number() && !value.is_null()) continue;
      if (std::ranges::find(figures, key, &Spread::figure) == figures.end()) {
        figures.push_back({.figure = key, .values = {}, .goal = {}});
      }
    }
  }
  return figures;
}

}  // namespace

Bounds share_interval(std::size_t hits, std::size_t count) {
  if (count == 0) return {0, 1};
  const double n = static_cast<double>(count), p = static_cast<double>(hits) / n;
  const double z2 = kTwoSided95 * kTwoSided95;
  const double middle = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half = kTwoSided95 * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n)) / (1 + z2 / n);
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

QuantileInterval quantile_interval(const std::vector<double>& sorted, double part) {
  constexpr double kTail = 0.025;
  const double n = static_cast<double>(sorted.size());
  QuantileInterval interval;
  // `below` is the chance that at most `rank` of the values are below the true quantile.
  double below = 0;
  for (std::size_t rank = 0; rank < sorted.size(); ++rank) {
    const double k = static_cast<double>(rank);
    below += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) +
                      k * std::log(part) + (n - k) * std::log1p(-part));
    if (below <= kTail) interval.low = sorted[rank];
    if (below >= 1 - kTail) {
      interval.high = sorted[rank];
      break;
    }
  }
  return interval;
}

double Spread::median() const { return bench::quantile(values, 0.5); }
double Spread::p95() const { return bench::quantile(values, 0.95); }

double Spread::rms() const {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double Spread::share_at_most(double limit) const {
  const auto below = std::ranges::upper_bound(values, limit) - values.begin();
  return static_cast<double>(below) / static_cast<double>(runs());
}

bool RunSpread::is_ok() const {
  const bool all_met =
      std::ranges::all_of(goals, [](const JudgedSweepGoal& goal) { return goal.fault.empty(); });
  return all_met && std::ranges::all_of(statuses, [&](const auto& status) {
           return status.first == "ok" || (status.first == "goals_missed" && !goals.empty());
         });
}

RunSpread spread_of(const std::vector<SeedReport>& reports, const DeploymentConfig& config,
                    std::vector<std::string> variation) {
  RunSpread all{.variation = std::move(variation), .figures = figures_of(reports), .failed = {}};
  for (Spread& spread : all.figures) {
    const auto goal = std::ranges::find_if(
        config.goals, [&](const Goal& one) { return is_of(spread.figure, one.metric); });
    if (goal != config.goals.end()) spread.goal = goal->limit;
    for (const auto& [seed, report] : reports) {
      const auto value = report->find(spread.figure);
      if (value == report->end() || !value->is_number()) {
        ++(does_not_apply(*report, spread.figure) ? spread.inapplicable : spread.unmeasured);
        continue;
      }
      spread.values.push_back(value->get<double>());
      if (spread.goal && spread.values.back() <= *spread.goal) ++spread.met;
    }
    std::ranges::sort(spread.values);
  }
  for (const auto& [seed, report] : reports) {
    const std::string status = report->value("status", "");
    if (status != "ok" && status != "goals_missed") {
      all.failed.push_back({seed, status, report->value("reason", "")});
    }
    const auto known =
        std::ranges::find(all.statuses, status, &decltype(all.statuses)::value_type::first);
    if (known == all.statuses.end()) {
      all.statuses.emplace_back(status, 1);
    } else {
      ++known->second;
    }
  }
  for (const SweepGoal& goal : config.sweep_goals) {
    const std::size_t before = all.goals.size();
    for (const Spread& spread : all.figures) {
      if (is_of(spread.figure, goal.metric)) all.goals.push_back(judged(goal, spread));
    }
    if (all.goals.size() == before) {
      all.goals.push_back({.goal = goal, .value = std::nan(""), .fault = "no run measured it"});
    }
  }
  return all;
}

}  // namespace armature::sweep
