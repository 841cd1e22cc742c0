// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "armature/robot/geometry/forbidden_zone.hpp"
#include "armature/values/expected.hpp"
#include "armature/volume/volume.hpp"
#include "sim_ct_head_parameters.hpp"

namespace armature::sim::ct_head {

/// What a head is told to hold, in the image's frame [m].
struct Anatomy {
  std::vector<Eigen::Vector3d> markers;
  Eigen::Vector3d lesion = Eigen::Vector3d::Zero();
  std::vector<ForbiddenZone> vessels;
};

/// The scan of such a head: all of it with a margin of air. Later ones of skin, skull, brain,
/// vessels, lesion and markers displace those before. Refuses an anatomy that is not of the size of
/// a head, or not finite.
Expected<Volume> scan(const Anatomy& anatomy, const Parameters& parameters, std::uint64_t seed);

}  // namespace armature::sim::ct_head
