// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "moves.hpp"

namespace armature::select::minmax {

/// The branches of every waypoint that can stand, in the solver's order.
using Waypoints = std::vector<std::vector<const IkBranch*>>;

/// How the sizes of a path's moves become one figure.
enum class Measure {
  greatest,  // of the moves that count
  sum,       // of all
};

/// What two paths may differ by and still be equal: rounding must not choose between them.
inline constexpr double kEqual = 1e-9;

/// A branch of a waypoint at one of the turns that moves lead to, and the least that the moves up
/// to there come to.
struct Place {
  Origin at;
  double so_far = 0;
};

/// The places of every waypoint that a least path may pass; the start is the first and only one of
/// layer 0.
struct Layers {
  std::vector<std::vector<Place>> of;  // one more than waypoints; fewer when one is not reached

  bool complete(const Waypoints& waypoints) const { return of.size() == waypoints.size() + 1; }
  /// The least of the measure over all paths. Complete layers only.
  double least() const;
};

/// Dynamic programming over branches x turns x waypoints, exact: O(waypoints * branches^2) where no
/// limit forces a joint the far way round, times the turns that the limits leave otherwise.
///
/// What lies behind a place is bounded from below as if every joint could always turn the near way,
/// which needs no turns (backward, branches only); what the bound and one path that there is rule
/// out is left out of the search over turns (forward).
class LeastPath {
 public:
  /// All outlive the search. A move that counts and is greater than `max_size` is not made.
  LeastPath(const Moves& moves, const Waypoints& waypoints, Measure measure,
            double max_size = std::numeric_limits<double>::infinity())
      : moves_{&moves}, waypoints_{&waypoints}, measure_{measure}, max_size_{max_size} {}

  /// Without places where no path goes on: ends before the waypoint that none reaches.
  Layers from(const JointVector& start) const;

  /// One position for each waypoint: of the paths that are equal to the least one the first in the
  /// solver's order, the last waypoint deciding first. `layers` are complete and of this search.
  std::vector<JointVector> first_of(const Layers& layers) const;

 private:
  using Bounds = std::vector<std::vector<double>>;
  Bounds bounds() const;
  double some_path(const JointVector& start, const Bounds& ahead) const;
  std::vector<Place> next(const std::vector<Place>& places, std::size_t waypoint,
                          const Bounds& ahead, double bound) const;

  double joined(double so_far, double size, bool counts) const;
  bool allowed(double size, bool counts) const { return !counts || size <= max_size_; }

  const Moves* moves_;
  const Waypoints* waypoints_;
  Measure measure_;
  double max_size_;
};

}  // namespace armature::select::minmax
