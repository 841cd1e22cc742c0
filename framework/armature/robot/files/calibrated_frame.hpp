// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string_view>

#include "armature/config/reader.hpp"

namespace armature {

/// Where a frame was found to be.
struct CalibratedFrame {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  std::optional<Eigen::Quaterniond> rotation;  // none: a point was calibrated (the tip of a tool)
};

/// Reads `<parent>_T_<frame>` from the file of `armature calibrate` that `path` names, relative to
/// the file in which it is written. Every problem goes to `problems`.
std::optional<CalibratedFrame> read_calibrated_frame(const config::Node& path,
                                                     std::string_view parent,
                                                     std::string_view frame,
                                                     config::Problems& problems);

}  // namespace armature
