// SPDX-License-Identifier: Apache-2.0
#include "bench/ik/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace armature::bench {
namespace {

Row row_of(const Series& series) {
  Row row{.plugin = series.plugin, .seeds = series.seeds};
  const std::vector<double> seconds = series.seconds();
  row.median_s = quantile(seconds, 0.5);
  row.p99_s = quantile(seconds, 0.99);
  for (const Solve& solve : series.solves) {
    row.reached += solve.reached ? 1 : 0;
    row.wrong += solve.wrong ? 1 : 0;
    row.allocations += static_cast<double>(solve.allocations);
  }
  row.reached /= static_cast<double>(series.solves.size());
  row.allocations /= static_cast<double>(series.solves.size());
  return row;
}

std::string ratio_text(const Row& row) {
  if (!row.times_base) return "";
  const auto& [lower, middle, upper] = *row.times_base;
  return fmt::format("{:.2f} [{:.2f}, {:.2f}]", middle, lower, upper);
}

}  // namespace

std::vector<Row> rows_of(const std::vector<Series>& series, const std::string& baseline,
                         std::uint64_t seed) {
  std::vector<Row> rows;
  for (const Series& one : series) {
    rows.push_back(row_of(one));
    const auto base = std::ranges::find_if(series, [&](const Series& other) {
      return other.plugin == baseline && other.seeds == one.seeds;
    });
    if (base == series.end()) continue;
    rows.back().times_base = ratio_of_medians(base->seconds(), one.seconds(), seed);
  }
  return rows;
}

std::string table(const Report& report) {
  std::size_t width = 6;
  for (const Row& row : report.rows) width = std::max(width, row.plugin.size());
  std::string text =
      fmt::format("{:<{}}  {:<6}  {:>10}  {:>10}  {:>9}  {:>5}  {:>11}  {}\n", "plugin", width,
                  "seeds", "median us", "p99 us", "reached", "wrong", "allocations",
                  report.baseline.empty() ? "" : fmt::format("times {} [95 %]", report.baseline));
  for (const Row& row : report.rows) {
    text += fmt::format(
        "{:<{}}  {:<6}  {:>10.3f}  {:>10.3f}  {:>7.2f} %  {:>5}  {:>11}  {}\n", row.plugin, width,
        to_string(row.seeds), 1e6 * row.median_s, 1e6 * row.p99_s, 100 * row.reached, row.wrong,
        report.counts_allocations ? fmt::format("{:.2f}", row.allocations) : "-", ratio_text(row));
  }
  for (const auto& [plugin, reason] : report.refused) {
    text += fmt::format("{:<{}}  not served: {}\n", plugin, width, reason);
  }
  return text + fmt::format(
                    "\n{} goals of robot '{}' ({}), seed {}; residual up to {:g} m and rad, within "
                    "limits\n"
                    "time of a goal: the least of {} repetitions; median and p99 over all goals, "
                    "reached or "
                    "not\n{}\n",
                    report.poses, report.robot, report.tip, report.seed, report.tolerance,
                    report.repetitions, to_text(report.machine));
}

nlohmann::ordered_json to_json(const Report& report) {
  using Json = nlohmann::ordered_json;
  Json json{{"robot", report.robot},         {"tip", report.tip},
            {"poses", report.poses},         {"seed", report.seed},
            {"tolerance", report.tolerance}, {"repetitions", report.repetitions},
            {"baseline", report.baseline}};
  json["machine"] = to_json(report.machine);
  json["rows"] = Json::array();
  for (const Row& row : report.rows) {
    Json line{{"plugin", row.plugin}, {"seeds", to_string(row.seeds)}, {"median_s", row.median_s},
              {"p99_s", row.p99_s},   {"reached", row.reached},        {"wrong", row.wrong}};
    if (report.counts_allocations) line["allocations"] = row.allocations;
    if (row.times_base) {
      line["times_baseline"] = row.times_base->middle;
      line["interval_95"] = {row.times_base->lower, row.times_base->upper};
    }
    json["rows"].push_back(line);
  }
  json["refused"] = Json::array();
  for (const auto& [plugin, reason] : report.refused) {
    json["refused"].push_back({{"plugin", plugin}, {"reason", reason}});
  }
  return json;
}

std::string csv_of(const std::vector<Series>& series) {
  std::string csv =
      "pose,plugin,seeds,seconds,reached,wrong,residual_m,residual_rad,branches,allocations\n";
  for (const Series& one : series) {
    for (std::size_t i = 0; i < one.solves.size(); ++i) {
      const Solve& solve = one.solves[i];
      csv += fmt::format("{},{},{},{:.4g},{:d},{:d},{:.4g},{:.4g},{},{}\n", i, one.plugin,
                         to_string(one.seeds), solve.seconds, solve.reached, solve.wrong,
                         solve.position_m, solve.angle_rad, solve.branches, solve.allocations);
    }
  }
  return csv;
}

}  // namespace armature::bench
