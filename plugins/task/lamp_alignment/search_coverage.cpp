// SPDX-License-Identifier: Apache-2.0
#include "search_coverage.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace armature::task::lamp_alignment {
namespace {

using Eigen::Isometry3d, Eigen::Matrix3d, Eigen::Vector2d, Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
// Of an adult's face, in eye distances: from the mouth up to the eyes, and the side of the square
// that detectors frame, from the brows to the chin.
constexpr double kMouthToEyes = 65.0 / 63.0;
constexpr double kFramedSide = 2.25;

/// The axes (d, side, d x side) as columns; `side` is made square to `d`.
Matrix3d frame_along(const Vector3d& d, const Vector3d& side) {
  Matrix3d axes;
  axes.col(0) = d.normalized();
  axes.col(1) = (side - side.dot(axes.col(0)) * axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

/// The frame `id` in the tool's, where both hang on the same link.
std::optional<Isometry3d> tool_T(FrameId id, const RobotModel& robot) {
  const NamedFrame &tool = robot.frame(robot.tool()), &other = robot.frame(id);
  if (tool.parent_joint != other.parent_joint) return std::nullopt;
  return tool.parent_T_frame.inverse() * other.parent_T_frame;
}

/// base_T_tool of a lamp that looks along `pose` and does not roll: the row of its cameras, along
/// `camera_right` in the tool's frame, is level.
Isometry3d base_T_tool(const ToolPose& pose, const Vector3d& pointing_axis,
                       const Vector3d& camera_right) {
  const Vector3d ahead = std::get<Direction>(pose.orientation).unit;
  // Straight up and down every heading is level.
  const Vector3d level = ahead.cross(Vector3d::UnitZ());
  const Vector3d right = level.norm() > 1e-9 ? level : Vector3d{-Vector3d::UnitY()};
  Isometry3d result = Isometry3d::Identity();
  result.linear() =
      frame_along(ahead, right) * frame_along(pointing_axis, camera_right).transpose();
  result.translation() = pose.position;
  return result;
}

bool is_in_picture(const Vector2d& pixel, const StereoCamera& camera) {
  return pixel.x() >= 0 && pixel.x() <= camera.width - 1 && pixel.y() >= 0 &&
         pixel.y() <= camera.height - 1;
}

/// The middle of step `i` of `count` between `low` and `high`.
double step_between(double low, double high, int i, int count) {
  return low + (high - low) * (i + 0.5) / count;
}

/// Faces counted in thirds of a place and of a turn.
struct Thirds {
  std::array<const char*, 3> places, turns;
  std::array<std::array<int, 3>, 3> faces{}, seen{};

  void add(int place, int turn, bool is_seen) {
    ++faces[static_cast<std::size_t>(place)][static_cast<std::size_t>(turn)];
    seen[static_cast<std::size_t>(place)][static_cast<std::size_t>(turn)] += is_seen ? 1 : 0;
  }
  void tell_blind(std::vector<SearchCoverage::Shares::Region>& blind) const {
    for (std::size_t place = 0; place < 3; ++place) {
      for (std::size_t turn = 0; turn < 3; ++turn) {
        const double share = static_cast<double>(seen[place][turn]) / faces[place][turn];
        if (share >= 0.5) continue;
        blind.push_back({fmt::format("{} and {}", places[place], turns[turn]), share});
      }
    }
  }
};

/// "4 % turned away ..": what is not seen, the greatest share first.
std::string reasons_text(const SearchCoverage::Shares& shares, double face_angle) {
  const auto share = [&](Sight sight) { return shares.of_sight[static_cast<std::size_t>(sight)]; };
  std::vector<std::pair<double, std::string>> reasons{
      {share(Sight::turned_away),
       fmt::format("turned away from every view by more than {:g} degrees", face_angle / kDegree)},
      {share(Sight::outside_pictures), "not whole in both pictures"},
      {share(Sight::at_wrong_depth), "too near, too far or too small"}};
  std::ranges::stable_sort(reasons, std::greater{},
                           [](const auto& reason) { return reason.first; });
  std::vector<std::string> parts;
  for (const auto& [of_all, what] : reasons) {
    if (of_all > 0) parts.push_back(fmt::format("{:.0f} % {}", 100 * of_all, what));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

/// What the detector frames, in the base frame.
struct SearchCoverage::Square {
  Vector3d centre, normal;
  std::array<Vector3d, 4> corners;
  double side;

  Square(const Face& face, double eye_distance) : side{kFramedSide * eye_distance} {
    const double cu = std::cos(face.tilt_up), su = std::sin(face.tilt_up);
    const double cs = std::cos(face.tilt_side), ss = std::sin(face.tilt_side);
    normal = {-cu * cs, cu * ss, su};
    const Vector3d right{-ss, -cs, 0}, up = right.cross(-normal);
    centre = face.mouth + 0.5 * kMouthToEyes * eye_distance * up;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      corners[i] = centre + 0.5 * side * ((i % 2 ? 1 : -1) * right + (i / 2 ? 1 : -1) * up);
    }
  }
};

std::optional<SearchCoverage> SearchCoverage::make(const Parameters& parameters,
                                                   const RobotModel& robot, const StereoRig& rig,
                                                   const std::vector<ToolPose>& views) {
  const auto mount = robot.find_frame(rig.mounted_on);
  if (!robot.pointing_axis() || !mount) return std::nullopt;
  const auto tool_T_mount = tool_T(*mount, robot);
  if (!tool_T_mount) return std::nullopt;
  const Isometry3d tool_T_left = *tool_T_mount * rig.mount_T_left;
  SearchCoverage coverage{parameters, rig.camera};
  for (const ToolPose& view : views) {
    const Isometry3d tool = base_T_tool(view, *robot.pointing_axis(), tool_T_left.linear().col(0));
    coverage.left_T_base_.push_back((tool * tool_T_left).inverse());
  }
  return coverage;
}

Sight SearchCoverage::sight_of(const Face& face) const {
  const Square square{face, parameters_.eye_distance};
  Sight best = Sight::outside_pictures;
  for (const Isometry3d& left_T_base : left_T_base_) {
    best = std::max(best, sight_from(left_T_base, square));
    if (best == Sight::seen) break;
  }
  return best;
}

Sight SearchCoverage::sight_from(const Isometry3d& left_T_base, const Square& square) const {
  for (const Vector3d& corner : square.corners) {
    const Vector3d p = left_T_base * corner;
    if (p.z() <= 0 || !is_in_picture(camera_.project_left(p), camera_) ||
        !is_in_picture(camera_.project_right(p), camera_)) {
      return Sight::outside_pictures;
    }
  }
  const Vector3d centre = left_T_base * square.centre;
  const double width_px = camera_.focal_px * square.side / centre.z();
  if (centre.z() < parameters_.min_face_depth || centre.z() > parameters_.max_face_depth ||
      width_px < parameters_.min_face) {
    return Sight::at_wrong_depth;
  }
  const Vector3d normal = left_T_base.linear() * square.normal;
  for (const double camera_x : {0.0, camera_.baseline_m}) {
    const Vector3d to_camera = Vector3d{camera_x, 0, 0} - centre;
    const double cosine = normal.dot(to_camera) / to_camera.norm();
    if (cosine < std::cos(parameters_.max_face_angle)) return Sight::turned_away;
  }
  return Sight::seen;
}

SearchCoverage::Shares SearchCoverage::shares() const {
  constexpr int kSteps = 6, kDepthSteps = 5, kStepsOfAThird = kSteps / 3;
  const auto &low = parameters_.min_mouth, &high = parameters_.max_mouth;
  const double tilt = parameters_.max_tilt;
  Thirds upright{.places = {"low", "at middle height", "high"},
                 .turns = {"turned down", "straight", "turned up"}};
  Thirds sideways{.places = {"to -y", "in the middle", "to +y"},
                  .turns = {"turned to -y", "straight", "turned to +y"}};
  std::array<int, 4> counts{};
  int all = 0;
  for (int i = 0; i < kDepthSteps * kSteps * kSteps * kSteps * kSteps; ++i) {
    const int y = i % kSteps, z = i / kSteps % kSteps, up = i / (kSteps * kSteps) % kSteps;
    const int side = i / (kSteps * kSteps * kSteps) % kSteps;
    const int x = i / (kSteps * kSteps * kSteps * kSteps);
    const Face face{.mouth = {step_between(low[0], high[0], x, kDepthSteps),
                              step_between(low[1], high[1], y, kSteps),
                              step_between(low[2], high[2], z, kSteps)},
                    .tilt_up = step_between(-tilt, tilt, up, kSteps),
                    .tilt_side = step_between(-tilt, tilt, side, kSteps)};
    const Sight sight = sight_of(face);
    ++counts[static_cast<std::size_t>(sight)];
    ++all;
    upright.add(z / kStepsOfAThird, up / kStepsOfAThird, sight == Sight::seen);
    sideways.add(y / kStepsOfAThird, side / kStepsOfAThird, sight == Sight::seen);
  }
  Shares shares;
  std::ranges::transform(counts, shares.of_sight.begin(),
                         [&](int count) { return static_cast<double>(count) / all; });
  upright.tell_blind(shares.blind);
  sideways.tell_blind(shares.blind);
  std::ranges::stable_sort(shares.blind, {}, &Shares::Region::seen);
  return shares;
}

std::vector<std::string> SearchCoverage::lines() const {
  const Shares shares = this->shares();
  const auto &low = parameters_.min_mouth, &high = parameters_.max_mouth;
  const double seen = shares.of_sight[static_cast<std::size_t>(Sight::seen)];
  // Not 100 where something is missed.
  const double percent = seen < 1 ? std::min(99.0, std::round(100 * seen)) : 100;
  std::vector<std::string> lines{fmt::format(
      "the search sees {:.0f} % of the faces that it promises: mouths at x {:g}..{:g} m, y "
      "{:g}..{:g} m, z {:g}..{:g} m, turned up, down and aside by up to {:g} degrees",
      percent, low[0], high[0], low[1], high[1], low[2], high[2], parameters_.max_tilt / kDegree)};
  if (seen == 1) return lines;
  std::vector<std::string> blind;
  constexpr std::size_t kMostNamed = 4;
  for (const auto& [name, share] :
       std::span{shares.blind}.first(std::min(kMostNamed, shares.blind.size()))) {
    blind.push_back(fmt::format("{} ({:.0f} %)", name, 100 * share));
  }
  lines.push_back(
      fmt::format("not seen are {}{}{}", reasons_text(shares, parameters_.max_face_angle),
                  blind.empty() ? "" : "; least is seen of those ", fmt::join(blind, ", ")));
  return lines;
}

}  // namespace armature::task::lamp_alignment
