// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/stereo_rig.hpp"

#include <fmt/format.h>

#include <cmath>

#include "armature/config/document.hpp"
#include "armature/config/key_rows.hpp"
#include "armature/config/reader.hpp"
#include "armature/robot/files/written_pose.hpp"

namespace armature {
namespace {

using config::KeySpec;
using config::MapReader;
using config::Node;
using config::Problems;
using Eigen::Vector3d;
using namespace config::rows;

constexpr double kSquareWithin = 1e-6;  // cosine between forward and right

void read_resolution(MapReader& map, StereoCamera& camera) {
  const auto size = map.optional_numbers("resolution");
  if (!size) return;
  for (const double pixels : *size) {
    if (pixels == std::floor(pixels)) continue;
    map.problem("resolution",
                fmt::format("'resolution' is [width, height] in whole pixels, not {}", pixels));
    return;
  }
  camera.width = static_cast<int>(size->front());
  camera.height = static_cast<int>(size->back());
}

void read_focal_length(MapReader& map, StereoCamera& camera) {
  const auto fov = map.optional_number("fov_deg");
  const auto focal = map.optional_number("focal_px");
  const bool both = map.node("fov_deg") && map.node("focal_px");
  const bool none = !map.node("fov_deg") && !map.node("focal_px");
  if (both) map.problem("focal_px", "'fov_deg' and 'focal_px' state the same; keep one");
  if (none) map.problem("fov_deg", "missing key 'fov_deg' in rig; or state 'focal_px'");
  // Pixel centres are at integers: the image reaches half a pixel further on both sides.
  if (fov) camera.focal_px = 0.5 * camera.width / std::tan(0.5 * *fov);
  if (focal) camera.focal_px = *focal;
}

void read_principal_point(MapReader& map, StereoCamera& camera) {
  const auto point = map.optional_numbers("principal_point_px");
  camera.cx = point ? point->front() : 0.5 * (camera.width - 1);
  camera.cy = point ? point->back() : 0.5 * (camera.height - 1);
}

void read_mount(const Node& node, StereoRig& rig, Problems& problems) {
  MapReader map{node, "mount", mount_keys(), problems};
  rig.mounted_on = map.text("frame");
  const Vector3d center = read_vector(map, "center_mm").value_or(Vector3d::Zero());
  const auto forward = read_direction(map, "forward");
  const auto right = read_direction(map, "right");
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

const std::vector<KeySpec>& rig_keys() {
  static const std::vector<KeySpec> kKeys{
      config::format_key("armature_rig"),
      text("name", "The rig's name."),
      numbers("resolution", "[width, height] in pixels.").count(2).range(1, 16384),
      number("fov_deg", "The horizontal field of view.").max(177).above(0).optional(),
      number("focal_px", "The focal length, instead of the field of view.").above(0).optional(),
      numbers("principal_point_px", "[x, y]; without: the middle of the image.")
          .count(2)
          .optional(),
      number("baseline_mm", "From the left camera to the right one.").above(0).also("baseline_m"),
      section("mount", "Where the rig hangs on the arm.")};
  return kKeys;
}

const std::vector<KeySpec>& mount_keys() {
  static const std::vector<KeySpec> kKeys{
      text("frame", "A frame of the robot."),
      numbers("center_mm", "The middle between the cameras, in that frame.")
          .count(3)
          .also("center_m")
          .optional(),
      numbers("forward", "Where the cameras look, in that frame.").count(3),
      numbers("right", "From the left camera to the right one, square to 'forward'.").count(3)};
  return kKeys;
}

StereoRig read_stereo_rig(const Node& document) {
  Problems problems;
  MapReader map{document, "rig", rig_keys(), problems};
  StereoRig rig;
  map.integer("armature_rig");
  rig.name = map.text("name");
  read_resolution(map, rig.camera);
  read_focal_length(map, rig.camera);
  read_principal_point(map, rig.camera);
  rig.camera.baseline_m = map.number("baseline_mm");
  if (const Node* mount = map.node("mount")) read_mount(*mount, rig, problems);
  map.finish();
  problems.throw_if_any();
  return rig;
}

StereoRig load_stereo_rig(const std::filesystem::path& file) {
  return read_stereo_rig(config::load(file));
}

}  // namespace armature
