// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature::sweep {

struct Bounds {
  double low = 0, high = 0;
};

/// Where the true share lies in 95 of 100 cases when `hits` of `count` were seen (Wilson 1927).
Bounds share_interval(std::size_t hits, std::size_t count);
/// The same of a quantile: the values between which it lies, by their ranks, whatever their
/// distribution (binomial; Conover 1999, section 3.2). No bound where there are too few values:
/// above the 95 % quantile before there are 73. `sorted` is not empty.
struct QuantileInterval {
  std::optional<double> low, high;
};
QuantileInterval quantile_interval(const std::vector<double>& sorted, double part);

/// One figure of all runs.
struct Spread {
  std::string figure;
  std::vector<double> values;  // of the runs that measured it, sorted
  std::size_t unmeasured = 0;
  std::size_t inapplicable = 0;  // of runs in which there was nothing to be measured
  std::optional<double> goal;    // of a single run, at most
  std::size_t met = 0;           // runs

  double median() const;
  double p95() const;
  double max() const { return values.back(); }
  double rms() const;
  /// The share of the runs that the figure applies to, measured or not, whose value is at most
  /// `limit`.
  double share_at_most(double limit) const;
  /// The count of the runs that it applies to.
  std::size_t runs() const { return values.size() + unmeasured; }
};

/// A sweep goal held against the runs; of a metric that several components tell one of each.
struct JudgedSweepGoal {
  SweepGoal goal;
  double value = 0;
  std::string fault;    // why it is not met, or ""
  bool applies = true;  // to any run
};

/// What a run told, and its seed.
struct SeedReport {
  std::uint64_t seed = 0;
  const nlohmann::ordered_json* report = nullptr;
};

/// A run that came to another end than ok or goals_missed.
struct FailedRun {
  std::uint64_t seed = 0;
  std::string status, reason;
};

/// All runs of one combination.
struct RunSpread {
  std::vector<std::string> variation;  // assignments
  bool is_pooled = false;  // of several combinations: runs are not independent, so no intervals
  std::vector<Spread> figures;                                // in the order of the report
  std::vector<std::pair<std::string, std::size_t>> statuses;  // "ok", 195
  std::vector<FailedRun> failed;
  std::vector<JudgedSweepGoal> goals;
  /// Whether all sweep goals are met and no run came to another end than ok or goals_missed;
  /// without sweep goals every run must be ok.
  bool is_ok() const;
};

RunSpread spread_of(const std::vector<SeedReport>& reports, const DeploymentConfig& config,
                    std::vector<std::string> variation);

}  // namespace armature::sweep
