// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/plan_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "armature/values/json_text.hpp"

namespace armature::bench {
namespace {

std::string text_of(const PlanRow& row, bool counts_allocations) {
  if (row.planned == 0)
    return fmt::format("{:<26}  {:<16}  not planned\n", row.name, to_string(row.shape));
  return fmt::format("{:<26}  {:<16}  {:>9.3f}  {:>9.3f}  {:>9.1f}  {:>11}  {:>10}  {}\n", row.name,
                     to_string(row.shape), 1e6 * row.plan_median_s, 1e6 * row.plan_p99_s,
                     1e9 * row.sample_s,
                     counts_allocations ? fmt::format("{:.2f}", row.allocations) : "-",
                     row.times_least ? fmt::format("{:.3f}", *row.times_least) : "-",
                     row.refused > 0 ? fmt::format("{} not planned", row.refused) : "");
}

std::string text_of(const InterpolatorRow& row) {
  return fmt::format(
      "{:<26}  {:>9.3f}  {:>9.1f}  {:>9.1f}  {:>7.4f}  {:>8.1f}  {:>9.1e}  {:>9.1e}\n", row.name,
      1e6 * row.build_s, 1e9 * row.sample_s, 1e9 * row.with_acceleration_s, row.turn,
      row.peak_acceleration, row.velocity_jump, row.acceleration_jump);
}

}  // namespace

std::string table(const PlanReport& report) {
  std::string text =
      fmt::format("{:<26}  {:<16}  {:>9}  {:>9}  {:>9}  {:>11}  {:>10}\n", "planner", "motion",
                  "median us", "p99 us", "sample ns", "allocations", "time/least");
  for (const PlanRow& row : report.plans) text += text_of(row, report.counts_allocations);
  for (const auto& [plugin, reason] : report.refused) {
    text += fmt::format("{:<26}  not served: {}\n", plugin, reason);
  }
  text +=
      fmt::format("\n{:<26}  {:>9}  {:>9}  {:>9}  {:>7}  {:>8}  {:>9}  {:>9}\n", "interpolator",
                  "build us", "sample ns", "with acc", "turn", "peak acc", "vel jump", "acc jump");
  for (const InterpolatorRow& row : report.interpolators) text += text_of(row);
  return text +
         fmt::format(
             "\n{} motions of robot '{}' from rest to rest, seed {}; a sample is q, v and a of all "
             "joints\ntime/least: the motion's duration over the least that velocity and "
             "acceleration limits allow, median\ninterpolators: {} random keys, parameter 0 to 1; "
             "a sample is the rotation and its angular velocity, with acc\nits angular "
             "acceleration "
             "too; turn as a multiple of the great arcs', rates in rad; keys at parameters in "
             "proportion\nto their turns, squad with the velocity at a key of its two turns over "
             "their time\ntimes: the least of {} "
             "repetitions; medians\n{}\n",
             report.motions, report.robot, report.seed, report.keys, report.repetitions,
             to_text(report.machine));
}

std::string to_json(const PlanReport& report) {
  using Json = nlohmann::ordered_json;
  Json json{{"robot", report.robot},
            {"motions", report.motions},
            {"keys", report.keys},
            {"seed", report.seed},
            {"repetitions", report.repetitions}};
  json["machine"] = to_json(report.machine);
  json["plans"] = Json::array();
  for (const PlanRow& row : report.plans) {
    Json line{{"planner", row.name},
              {"motion", to_string(row.shape)},
              {"planned", row.planned},
              {"not_planned", row.refused}};
    if (row.planned > 0) {
      line.update(
          {{"median_s", row.plan_median_s}, {"p99_s", row.plan_p99_s}, {"sample_s", row.sample_s}});
      if (report.counts_allocations) line["allocations"] = row.allocations;
    }
    if (row.times_least) line["times_least"] = *row.times_least;
    json["plans"].push_back(line);
  }
  json["interpolators"] = Json::array();
  for (const InterpolatorRow& row : report.interpolators) {
    json["interpolators"].push_back({{"interpolator", row.name},
                                     {"build_s", row.build_s},
                                     {"sample_s", row.sample_s},
                                     {"with_acceleration_s", row.with_acceleration_s},
                                     {"turn", row.turn},
                                     {"peak_acceleration", row.peak_acceleration},
                                     {"velocity_jump", row.velocity_jump},
                                     {"acceleration_jump", row.acceleration_jump}});
  }
  json["refused"] = Json::array();
  for (const auto& [plugin, reason] : report.refused) {
    json["refused"].push_back({{"plugin", plugin}, {"reason", reason}});
  }
  return json_text(json);
}

}  // namespace armature::bench
