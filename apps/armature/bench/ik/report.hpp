// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/ik/measure.hpp"
#include "bench/machine.hpp"
#include "bench/statistics.hpp"

namespace armature::bench {

/// A series in one line.
struct Row {
  std::string plugin;
  Seeds seeds = Seeds::random;
  double median_s = 0, p99_s = 0;
  double reached = 0;                  // part of the goals, 0 to 1
  int wrong = 0;                       // solves with a branch that is not what it says
  double allocations = 0;              // per solve
  std::optional<Interval> times_base;  // how many times the baseline's median is this one's
};

/// Everything that was measured and how.
struct Report {
  std::string robot, tip;
  int poses = 0;
  std::uint64_t seed = 0;
  double tolerance = 0;  // [m] and [rad]
  int repetitions = 0;
  std::string baseline;  // a plugin; empty: none
  bool counts_allocations = false;
  Machine machine;
  std::vector<Row> rows;
  struct Refused {
    std::string plugin, reason;
  };
  std::vector<Refused> refused;
};

/// One row per series, against the series of `report.baseline` from the same sort of seeds.
std::vector<Row> rows_of(const std::vector<Series>& series, const std::string& baseline,
                         std::uint64_t seed);

std::string table(const Report& report);
nlohmann::ordered_json to_json(const Report& report);

/// One line per solve: pose, plugin, seeds, seconds, reached, residuals, branches, allocations.
std::string csv_of(const std::vector<Series>& series);

/// Which part of the solves took how long, as SVG: log x, one line per series, near seeds dashed.
std::string plot_of(const Report& report, const std::vector<Series>& series);

}  // namespace armature::bench
