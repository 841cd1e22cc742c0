// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/allocations.hpp"
#include "bench/ik/poses.hpp"

namespace armature::bench {

/// A solver in the race.
struct Runner {
  std::string plugin;
  std::shared_ptr<const IkSolver> solver;
};

/// One goal asked from one seed.
struct Solve {
  double seconds = 0;     // the least of all repetitions, the clock's own time taken off
  bool reached = false;   // a branch within limits and tolerance, by the bench's own check
  bool wrong = false;     // a branch that the solver says is within limits, and is not or misses
  double position_m = 0;  // of the best branch within limits; infinite without one
  double angle_rad = 0;
  int branches = 0;
  std::size_t allocations = 0;
};

/// Every solve of one runner from one sort of seeds, in the order of the poses.
struct Series {
  std::string plugin;
  Seeds seeds = Seeds::random;
  std::vector<Solve> solves;

  std::vector<double> seconds() const;
};

struct MeasureOptions {
  std::vector<Seeds> seeds{Seeds::random, Seeds::near};
  int repetitions = 5;
  std::uint64_t order = 1;  // seed of the order of work
  AllocationCounter allocations = nullptr;
  std::function<void(double part)> progress;  // 0 to 1
};

/// Asks every runner every pose from every sort of seeds. First without a clock: the answers are
/// checked and counted, and caches are warm. Then `repetitions` times with it: 50 poses at a time,
/// the runners take turns in random order, so that whatever slows the machine slows all of them.
std::vector<Series> measure(const RobotModel& model, const std::vector<Runner>& runners,
                            const std::vector<Pose>& poses, const MeasureOptions& options);

}  // namespace armature::bench
