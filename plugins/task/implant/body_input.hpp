// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <string>
#include <utility>

#include "armature/calibration/usable_pose.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "sighting.hpp"

namespace armature::task::implant {

/// The topic of one body. A body without a name is taken for it; another one is not.
class BodyInput {
 public:
  BodyInput(Setup& setup, const std::string& port, std::string body)
      : bodies_{setup.input<msg::TrackedBody>(port)}, expected_{std::move(body)} {}

  std::size_t size() const { return bodies_.size(); }
  Sighting operator[](std::size_t i) const { return as(i, expected_); }
  /// The same, with the body expected that is named so.
  Sighting as(std::size_t i, const std::string& expected) const {
    const msg::TrackedBody& body = bodies_[i];
    Sighting sighting{.stamp = stamp_of(body.header_().stamp_()), .tracker_T_body = {}};
    if (!body.body_().empty() && body.body_() != expected) {
      sighting.reason =
          fmt::format("its topic tells of the body '{}', not of '{}'", body.body_(), expected);
      return sighting;
    }
    if (!body.valid_()) {
      sighting.reason = body.reason_();
      return sighting;
    }
    const Eigen::Isometry3d pose = to_eigen(body.pose_());
    if (const auto wrong = wrong_with(pose)) {
      sighting.reason = "its pose " + *wrong;
    } else {
      sighting.tracker_T_body = pose;
    }
    return sighting;
  }

 private:
  Input<msg::TrackedBody> bodies_;
  std::string expected_;
};

}  // namespace armature::task::implant
