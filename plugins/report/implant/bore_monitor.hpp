// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

#include "armature/robot/geometry/guided_chain.hpp"
#include "report_implant_parameters.hpp"

namespace armature::report::implant {

/// Where a tool has to come to.
struct Site {
  Eigen::Isometry3d image_T_site;
  double longer_m = 0;  // than the chain says the tool is here, by the implant that it holds
};

/// What came of the bore at one site, or of the implant in it.
struct Bore : Site {
  /// Where the drill was deepest along the site's true axis: its tip from the site [m], in the base
  /// frame, and its axis against the site's. None before it was in.
  std::optional<Eigen::Vector3d> error = {};
  double axis_error_rad = 0;
  GuidedChain estimate = {}, truth = {};  // at that instant
  /// As the arm believed, the farthest off the site's axis and the most tilted against it inside.
  double line_deviation_m = 0, line_tilt_rad = 0;
  double deepest_m = 0;  // from the true bottom
  /// Off its axis as the arm believes; a drill that comes in farther off is elsewhere.
  double near_m = 0;
};

/// Two sites, from 0, that one bore would serve: which of them a drill is at is not told.
struct OneAxis {
  std::size_t first, second;
};

/// Watches a tool at all sites of a plan: a drill, or a driver with implants. Where it is in is
/// judged as the arm believes: however wrong its chain is, it knows which site it drills. Once in,
/// it is in until it is out above or near another site, however far it goes off the axis.
class BoreMonitor {
 public:
  /// `estimate`: what the arm believes.
  BoreMonitor(const std::vector<Site>& sites, const GuidedChain& estimate,
              const Parameters& parameters);

  /// From now on, while the tool is out. What was drilled before keeps what it was drilled by.
  void believe(const GuidedChain& estimate);
  void see(const Eigen::Isometry3d& base_T_flange, const GuidedChain& truth);

  const std::vector<Bore>& bores() const { return bores_; }
  /// The first two whose bores begin on one axis.
  std::optional<OneAxis> one_axis() const;

 private:
  /// As the arm believes, from where bore `i` begins, `depth` above its bottom, to another's axis.
  double entry_to_axis(std::size_t i, std::size_t other) const;

  Parameters parameters_;
  std::vector<Bore> bores_;
  GuidedChain estimate_;
  std::vector<Eigen::Isometry3d> site_T_base_;  // of bores_, as the arm believes
  std::optional<std::size_t> inside_;           // of bores_: where the drill was last
};

}  // namespace armature::report::implant
