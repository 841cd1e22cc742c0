// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/measure_plans.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <random>

#include "bench/clock.hpp"
#include "bench/random_joints.hpp"
#include "bench/statistics.hpp"
#include "bench/turns.hpp"

namespace armature::bench {
namespace {

constexpr std::size_t kSamplesOfAPlan = 64;

struct Timed {
  bool planned = false;
  std::size_t allocations = 0;
  double duration_s = 0;
  double plan_s = std::numeric_limits<double>::infinity();
  double sample_s = std::numeric_limits<double>::infinity();
};

Timed counted(Planner& planner, const Motion& motion, AllocationCounter allocations) {
  Timed timed;
  const std::size_t before = allocations ? allocations() : 0;
  timed.planned = planner.plan(motion.request);
  if (allocations) timed.allocations = allocations() - before;
  timed.duration_s = planner.duration_s();
  return timed;
}

class Race {
 public:
  Race(const std::vector<Motion>& motions, std::uint64_t order)
      : motions_{motions}, clock_s_{clock_seconds()} {
    std::mt19937_64 random{order};
    for (double& part : parts_) part = unit(random);
  }

  void run(Planner& planner, std::size_t from, std::size_t to, std::vector<Timed>& all) {
    for (std::size_t i = from; i < to; ++i) {
      if (all[i].planned) run(planner, motions_[i], all[i]);
    }
  }

 private:
  void run(Planner& planner, const Motion& motion, Timed& timed) {
    const auto start = Clock::now();
    planner.plan(motion.request);
    const auto planned = Clock::now();
    double sum = 0;
    for (const double part : parts_) sum += planner.sample(part * timed.duration_s);
    kept_ = sum;
    const auto sampled = Clock::now();
    const double plan_s = seconds_between(start, planned) - clock_s_;
    const double samples_s = seconds_between(planned, sampled) - clock_s_;
    timed.plan_s = std::min(timed.plan_s, std::max(0.0, plan_s));
    timed.sample_s = std::min(timed.sample_s, std::max(0.0, samples_s) / kSamplesOfAPlan);
  }

  const std::vector<Motion>& motions_;
  double clock_s_;
  std::array<double, kSamplesOfAPlan> parts_;
  volatile double kept_ = 0;  // so that no sample can be left out
};

PlanRow row_of(const std::string& name, Shape shape, const std::vector<Motion>& motions,
               const std::vector<Timed>& all) {
  PlanRow row{.name = name, .shape = shape};
  std::vector<double> plan, sample, times;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].planned) continue;
    plan.push_back(all[i].plan_s);
    sample.push_back(all[i].sample_s);
    times.push_back(all[i].duration_s / motions[i].min_s);
    row.allocations += static_cast<double>(all[i].allocations);
  }
  row.planned = static_cast<int>(plan.size());
  row.refused = static_cast<int>(all.size() - plan.size());
  row.allocations /= std::max(1.0, static_cast<double>(plan.size()));
  row.plan_median_s = quantile(plan, 0.5);
  row.plan_p99_s = quantile(plan, 0.99);
  row.sample_s = quantile(sample, 0.5);
  if (shape == Shape::point_to_point && !times.empty()) row.times_least = quantile(times, 0.5);
  return row;
}

}  // namespace

std::vector<PlanRow> measure_plans(const std::vector<NamedPlanner>& planners, Shape shape,
                                   const std::vector<Motion>& motions,
                                   const MeasurePlansOptions& options) {
  std::vector<std::vector<Timed>> all(planners.size());
  for (std::size_t k = 0; k < planners.size(); ++k) {
    for (const Motion& motion : motions) {
      all[k].push_back(counted(*planners[k].planner, motion, options.allocations));
    }
  }
  Race race{motions, options.order};
  take_turns({.contestants = planners.size(),
              .items = motions.size(),
              .repetitions = options.repetitions,
              .order = options.order,
              .progress = options.progress},
             [&](std::size_t k, std::size_t from, std::size_t to) {
               race.run(*planners[k].planner, from, to, all[k]);
             });
  std::vector<PlanRow> rows;
  for (std::size_t k = 0; k < planners.size(); ++k) {
    rows.push_back(row_of(planners[k].name, shape, motions, all[k]));
  }
  return rows;
}

}  // namespace armature::bench
