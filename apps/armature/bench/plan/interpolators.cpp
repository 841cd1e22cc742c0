// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/interpolators.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <random>

#include "armature/robot/orientations/curve_measures.hpp"
#include "bench/clock.hpp"
#include "bench/random_joints.hpp"
#include "bench/statistics.hpp"

namespace armature::bench {
namespace {

using Keys = std::vector<Eigen::Quaterniond>;

constexpr std::array kNames{"slerp", "squad", "rotvec_bspline", "chart_bspline"};
constexpr int kSamplesOfACurve = 1000;  // that are timed
constexpr int kSamplesOfAPiece = 40;
constexpr double kBeside = 1e-6;  // of a piece, before and behind the place of a jump

struct Figures {
  std::vector<double> build_s, sample_s, with_acceleration_s, turn, peak, velocity_jump,
      acceleration_jump;
};

/// [s] of one sample of many.
double sample_time(const OrientationCurve& curve, Rates rates, double clock_s) {
  volatile double kept = 0;  // so that no sample can be left out
  const auto start = Clock::now();
  double sum = 0;
  for (int i = 0; i < kSamplesOfACurve; ++i) {
    const OrientationState state = curve.at(static_cast<double>(i) / kSamplesOfACurve, rates);
    sum += state.rotation.w() + state.velocity.x() + state.acceleration.y();
  }
  kept = sum;
  static_cast<void>(kept);
  return std::max(0.0, seconds_between(start, Clock::now()) - clock_s) / kSamplesOfACurve;
}

void add_times(const Keys& keys, OrientationInterpolator kind, int repetitions, double clock_s,
               Figures& figures) {
  double build = std::numeric_limits<double>::infinity(), sample = build, accelerated = build;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    const auto start = Clock::now();
    const auto curve = OrientationCurve::through(keys, kind);
    build = std::min(build, seconds_between(start, Clock::now()) - clock_s);
    sample = std::min(sample, sample_time(*curve, Rates::velocity, clock_s));
    accelerated = std::min(accelerated, sample_time(*curve, Rates::acceleration, clock_s));
  }
  figures.build_s.push_back(std::max(0.0, build));
  figures.sample_s.push_back(sample);
  figures.with_acceleration_s.push_back(accelerated);
}

}  // namespace

std::vector<InterpolatorRow> measure_interpolators(int curves, int keys, std::uint64_t seed,
                                                   int repetitions) {
  std::array<Figures, kNames.size()> figures;
  std::mt19937_64 random{seed};
  const double clock_s = clock_seconds();
  for (int i = 0; i < curves; ++i) {
    Keys own(static_cast<std::size_t>(keys));
    for (Eigen::Quaterniond& key : own) key = any_rotation(random);
    double shortest = 0;  // the great arcs'
    for (std::size_t k = 0; k < kNames.size(); ++k) {
      const auto kind = *orientation_interpolator(kNames[k]);
      const auto curve = OrientationCurve::through(own, kind);
      if (!curve) continue;  // two neighbours half a turn apart
      const double turn = total_rotation(*curve, kSamplesOfAPiece);
      if (k == 0) shortest = turn;
      figures[k].turn.push_back(turn / shortest);
      figures[k].peak.push_back(peaks_of(*curve, kSamplesOfAPiece).acceleration);
      const OrientationJump jump = largest_jump_beside(*curve, kBeside);
      figures[k].velocity_jump.push_back(jump.velocity);
      figures[k].acceleration_jump.push_back(jump.acceleration);
      add_times(own, kind, repetitions, clock_s, figures[k]);
    }
  }
  std::vector<InterpolatorRow> rows;
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    const Figures& all = figures[k];
    rows.push_back({.name = kNames[k],
                    .build_s = quantile(all.build_s, 0.5),
                    .sample_s = quantile(all.sample_s, 0.5),
                    .with_acceleration_s = quantile(all.with_acceleration_s, 0.5),
                    .turn = quantile(all.turn, 0.5),
                    .peak_acceleration = quantile(all.peak, 0.5),
                    .velocity_jump = quantile(all.velocity_jump, 0.5),
                    .acceleration_jump = quantile(all.acceleration_jump, 0.5)});
  }
  return rows;
}

}  // namespace armature::bench
