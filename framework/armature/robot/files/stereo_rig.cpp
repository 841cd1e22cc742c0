// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/stereo_rig.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "armature/config/document.hpp"
#include "armature/config/reader.hpp"
#include "armature/robot/files/quantity_reader.hpp"

namespace armature {
namespace {

using config::MapReader;
using config::Node;
using config::Problems;
using Eigen::Vector3d;

constexpr double kMaxPixels = 16384;    // per side
constexpr double kSquareWithin = 1e-6;  // cosine between forward and right

void read_resolution(MapReader& map, StereoCamera& camera, Problems& problems) {
  const Quantity size = require_quantity(map, {"resolution"}, 2, problems);
  if (size.si.size() != 2) return;
  for (const double pixels : size.si)
    if (!(pixels >= 1 && pixels <= kMaxPixels && pixels == std::floor(pixels))) {
      map.problem("resolution",
                  fmt::format("'resolution' is [width, height] in whole pixels from 1 "
                              "to {:.0f}, not {}",
                              kMaxPixels, pixels));
      return;
    }
  camera.width = static_cast<int>(size.si[0]);
  camera.height = static_cast<int>(size.si[1]);
}

void read_focal_length(MapReader& map, StereoCamera& camera, Problems& problems) {
  const Quantity fov = read_quantity(map, {"fov_deg"}, 1, problems);
  const Quantity focal = read_quantity(map, {"focal_px"}, 1, problems);
  if (fov.node && focal.node)
    map.problem("focal_px", "'fov_deg' and 'focal_px' state the same; keep one");
  else if (!fov.node && !focal.node)
    map.node("fov_deg");  // notes that it is missing
  if (const auto angle = fov.number()) {
    if (!(*angle > 0 && *angle < 3.1))
      map.problem("fov_deg",
                  "'fov_deg' is the horizontal field of view, more than 0 and less than "
                  "177 degrees");
    // Pixel centres are at integers: the image reaches half a pixel further on both sides.
    camera.focal_px = 0.5 * camera.width / std::tan(0.5 * *angle);
  }
  if (const auto pixels = focal.number()) {
    if (!(*pixels > 0)) map.problem("focal_px", "'focal_px' must be more than 0");
    camera.focal_px = *pixels;
  }
}

void read_principal_point(MapReader& map, StereoCamera& camera, Problems& problems) {
  const Quantity point = read_quantity(map, {"principal_point_px"}, 2, problems);
  const bool written = point.si.size() == 2;
  camera.cx = written ? point.si[0] : 0.5 * (camera.width - 1);
  camera.cy = written ? point.si[1] : 0.5 * (camera.height - 1);
}

void read_baseline(MapReader& map, StereoCamera& camera, Problems& problems) {
  const Quantity baseline = require_quantity(map, {"baseline_mm", "baseline_m"}, 1, problems);
  camera.baseline_m = baseline.number().value_or(0);
  if (baseline.number() && !(camera.baseline_m > 0))
    map.problem(baseline.key, fmt::format("'{}' must be more than 0", baseline.key));
}

std::optional<Vector3d> read_direction(MapReader& map, std::string_view key, Problems& problems) {
  const auto vector = require_quantity(map, {key}, 3, problems).vector();
  if (!vector) return std::nullopt;
  if (vector->norm() > 1e-6) return vector->normalized();
  map.problem(key, fmt::format("'{}' has no length", key));
  return std::nullopt;
}

void read_mount(const Node& node, StereoRig& rig, Problems& problems) {
  MapReader map{node, "mount", problems};
  rig.mounted_on = map.text("frame");
  const Vector3d center = read_quantity(map, {"center_mm", "center_m"}, 3, problems)
                              .vector()
                              .value_or(Vector3d::Zero());
  const auto forward = read_direction(map, "forward", problems);
  const auto right = read_direction(map, "right", problems);
  map.finish();
  if (!forward || !right) return;
  if (std::abs(forward->dot(*right)) > kSquareWithin) {
    map.problem("right", fmt::format("'right' must be square to 'forward'; they are {:.1f} degrees "
                                     "apart",
                                     std::acos(forward->dot(*right)) * 45 / std::atan(1.0)));
    return;
  }
  rig.mount_T_left.linear() << *right, forward->cross(*right), *forward;
  rig.mount_T_left.translation() = center - 0.5 * rig.camera.baseline_m * *right;
}

}  // namespace

StereoRig read_stereo_rig(const Node& document) {
  Problems problems;
  MapReader map{document, "rig", problems};
  StereoRig rig;
  check_format(map, "armature_rig", problems);
  rig.name = map.text("name");
  read_resolution(map, rig.camera, problems);
  read_focal_length(map, rig.camera, problems);
  read_principal_point(map, rig.camera, problems);
  read_baseline(map, rig.camera, problems);
  if (const Node* mount = map.node("mount")) read_mount(*mount, rig, problems);
  map.finish();
  problems.throw_if_any();
  return rig;
}

StereoRig load_stereo_rig(const std::filesystem::path& file) {
  return read_stereo_rig(config::load(file));
}

}  // namespace armature
