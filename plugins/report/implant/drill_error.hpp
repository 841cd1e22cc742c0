// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "armature/robot/geometry/guided_chain.hpp"

namespace armature::report::implant {

/// By which the drill's tip misses a site [m], in the base frame, when the flange is where
/// `estimate` says that it has to be.
Eigen::Vector3d tip_error(const GuidedChain& estimate, const GuidedChain& truth,
                          const Eigen::Isometry3d& image_T_site);

/// The same by what brings it about: the true chain with one of its estimates in it, each in turn.
/// They add up to the whole, to first order.
struct ErrorBudget {
  Eigen::Vector3d registration, hand_eye, tool, tracker;

  Eigen::Vector3d sum() const { return registration + hand_eye + tool + tracker; }
};

ErrorBudget error_budget(const GuidedChain& estimate, const GuidedChain& truth,
                         const Eigen::Isometry3d& image_T_site);

}  // namespace armature::report::implant
