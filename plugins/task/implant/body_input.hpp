// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "armature/kinds/pose_messages.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/ports.hpp"
#include "sighting.hpp"

namespace armature::task::implant {

/// The topic of one body. A body without a name is taken for it; another one is not, nor is one in
/// another frame than the tracker's, in which all bodies are stated, one whose spheres do not fit,
/// or one whose quaternion is no unit.
class BodyInput {
 public:
  BodyInput(Input<msg::TrackedBody> bodies, std::string body, double max_fit_error_m)
      : bodies_{bodies}, expected_{std::move(body)}, max_fit_error_m_{max_fit_error_m} {}

  std::size_t size() const { return bodies_.size(); }
  Sighting operator[](std::size_t i) const { return as(i, expected_); }
  /// The same, with the body expected that is named so.
  Sighting as(std::size_t i, const std::string& expected) const {
    const msg::TrackedBody& body = bodies_[i];
    Sighting sighting{.stamp = stamp_of(body.header_().stamp_()), .tracker_T_body = {}};
    if (const auto off = defect(body, expected)) {
      sighting.reason = *off;
    } else if (const auto pose = pose_of(body.pose_(), "its")) {
      sighting.tracker_T_body = *pose;
    } else {
      sighting.reason = pose.error().text;
    }
    return sighting;
  }

 private:
  std::optional<std::string> defect(const msg::TrackedBody& body,
                                    const std::string& expected) const {
    if (!body.body_().empty() && body.body_() != expected) {
      return fmt::format("its topic tells of the body '{}', not of '{}'", body.body_(), expected);
    }
    if (!body.valid_()) return body.reason_();
    constexpr const char* kTrackerFrame = "tracker";
    const std::string& frame = body.header_().frame_id_();
    if (frame != kTrackerFrame) {
      return fmt::format("its pose is stated in frame '{}', not in '{}'", frame, kTrackerFrame);
    }
    const double error_m = body.fit_error_();
    if (error_m >= 0 && error_m <= max_fit_error_m_) return std::nullopt;
    return fmt::format("its spheres fit to {:.4g} mm rms, {}", 1e3 * error_m,
                       error_m > max_fit_error_m_
                           ? fmt::format("'max_fit_error_mm' is {:g}", 1e3 * max_fit_error_m_)
                           : "which is no error");
  }

  Input<msg::TrackedBody> bodies_;
  std::string expected_;
  double max_fit_error_m_;
};

}  // namespace armature::task::implant
