// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "armature/kinds/target/target.hpp"

namespace armature::target::constant_velocity {

/// How much more measurements scatter than their covariances say, learned from how each one differs
/// from the line through the two before it: a target that goes on as it did has no part in that,
/// and one that starts or stops only in a few of them, which a median leaves out (the second
/// differences of von Neumann et al. 1941, "The mean square successive difference"). Plain numbers,
/// as a part of what is remembered.
struct Scatter {
  static constexpr int kWindow = 40;

  struct Sight {
    Time stamp;
    std::array<double, 3> position, normal;
  };
  /// Squares in units of what the covariances explain, 1 in the median where they are right: the
  /// newest kWindow.
  struct Ratios {
    std::array<float, kWindow> newest;
    /// The median, at least 1; 1 while there are too few to tell.
    double inflation(int count) const;
  };

  int sights, ratios;  // that were added
  Sight last, before_last;
  Ratios of_position, of_normal;

  void add(const TargetMeasurement& measurement);
  /// With covariances that explain how measurements scatter.
  TargetMeasurement explained(TargetMeasurement measurement) const;
};

}  // namespace armature::target::constant_velocity
