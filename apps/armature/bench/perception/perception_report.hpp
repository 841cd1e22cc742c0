// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/machine.hpp"
#include "bench/perception/measure_pairs.hpp"

namespace armature::bench {

/// Median, 95 of 100 and the largest; NaN of none.
struct Spread {
  double median, p95, max;
};
Spread spread_of(const std::vector<double>& values);

/// One group of cases, or all.
struct PerceptionRow {
  std::string group;
  int pairs = 0;
  int detected = 0;            // with landmarks in both pictures
  int refused = 0;             // of those, by the estimator
  int wrong = 0;               // valid and wrong (kMaxMouthError_m, kMaxNormalError_rad)
  Spread normal_rad, mouth_m;  // of valid estimates, against what was drawn
  Spread stereo_only_normal_rad, stereo_only_mouth_m;  // against where the finder takes the points
};

/// What a stage took of pairs that were fresh, or tracked: the median [s], and as a multiple of a
/// full pass of the detector over a left picture in the same run.
struct StageRow {
  std::string stage;
  int pairs = 0;
  double median_s = 0, full_passes = 0;
};

/// Everything that was measured and how.
struct PerceptionReport {
  std::string detector, landmarks, face_pose, deployment, rig;
  std::uint64_t seed = 0;
  Machine machine;
  std::vector<PerceptionRow> rows;  // in the order of the groups; the last one is of all
  std::vector<StageRow> stages;
};

std::vector<PerceptionRow> rows_of(const std::vector<PairResult>& results);
std::vector<StageRow> stages_of(const std::vector<PairResult>& results);

std::string table(const PerceptionReport& report);
std::string to_json(const PerceptionReport& report);
/// One line per pair.
std::string csv_of(const std::vector<PairResult>& results);

}  // namespace armature::bench
