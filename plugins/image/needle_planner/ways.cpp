// SPDX-License-Identifier: Apache-2.0
#include "ways.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "armature/kinds/geometry_params.hpp"
#include "armature/values/angles.hpp"
#include "crossing.hpp"

namespace armature::image::needle_planner {
namespace {

using Eigen::Vector3d;

constexpr int kDirections = 4000;  // over the sphere: 3.2 degrees from one to the next
constexpr double kOutside = 0.06;  // [m] of the way before the skin that markers must leave free

/// Evenly over the sphere (Fibonacci's spiral).
Vector3d direction_of(int i) {
  const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
  const double z = 1 - 2 * (i + 0.5) / kDirections;
  const double across = std::sqrt(1 - z * z);
  return {across * std::cos(i * turn), across * std::sin(i * turn), z};
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

/// What kept ways out.
struct Kept {
  int sought = 0, closed = 0, long_ways = 0, slanting = 0, vessels = 0, markers = 0;
};

/// The way along one direction, or nothing and a count in `kept`.
std::optional<Way> way_along(const Vector3d& direction, const Vector3d& target,
                             const Volume& volume, const std::vector<ForbiddenZone>& vessels,
                             const std::vector<ForbiddenZone>& markers,
                             const Parameters& parameters, Kept& kept) {
  const auto out = [](int& count) { return ++count, std::nullopt; };
  ++kept.sought;
  const auto crossing = crossing_of(volume, target, direction, parameters.bone_from, markers);
  if (!crossing) return out(kept.closed);
  Way way{.entry = crossing->skin,
          .length = (crossing->skin - target).norm(),
          .vessel_distance = std::numeric_limits<double>::infinity(),
          .skull_angle = crossing->skull_angle};
  if (way.length > parameters.max_length) return out(kept.long_ways);
  if (way.skull_angle > parameters.max_skull_angle) return out(kept.slanting);
  const Vector3d outside = way.entry + kOutside * direction;
  for (const ForbiddenZone& marker : markers) {
    if (clearance(target, outside, marker) < 0) return out(kept.markers);
  }
  for (const ForbiddenZone& vessel : vessels) {
    const double distance = clearance(target, way.entry, vessel);
    if (distance >= way.vessel_distance) continue;
    way.vessel_distance = distance;
    way.vessel = vessel.name;
  }
  if (way.vessel_distance < parameters.min_vessel_distance) return out(kept.vessels);
  way.vessel_cost =
      std::max(parameters.min_vessel_distance, 1e-4) / std::max(way.vessel_distance, 1e-4);
  way.length_cost = way.length / parameters.max_length;
  way.angle_cost = way.skull_angle / parameters.max_skull_angle;
  way.cost = parameters.weights[0] * way.vessel_cost + parameters.weights[1] * way.length_cost +
             parameters.weights[2] * way.angle_cost;
  return way;
}

std::string reason_of(const Kept& kept) {
  return fmt::format(
      "no way in: of {} directions {} meet no skull and skin, {} are too long, {} "
      "meet the skull too aslant, {} go through a marker, {} come too near to a "
      "vessel",
      kept.sought, kept.closed, kept.long_ways, kept.slanting, kept.markers, kept.vessels);
}

}  // namespace

std::string reason_of(const Way& way) {
  const std::string vessel = way.vessel.empty()
                                 ? "no vessel"
                                 : fmt::format("{} is {:.1f} mm away ({:.2f})", way.vessel,
                                               1e3 * way.vessel_distance, way.vessel_cost);
  return fmt::format("{}, {:.0f} mm long ({:.2f}), {:.0f} degrees off the skull's normal ({:.2f})",
                     vessel, 1e3 * way.length, way.length_cost, kDegreesPerRad * way.skull_angle,
                     way.angle_cost);
}

Expected<std::vector<Way>> ways_to(const Vector3d& target, const Volume& volume,
                                   const std::vector<ForbiddenZone>& vessels,
                                   const std::vector<ForbiddenZone>& markers,
                                   const Parameters& parameters) {
  const Vector3d approach = vector_of(parameters.approach).normalized();
  std::vector<Way> all;
  Kept kept;
  for (int i = 0; i < kDirections; ++i) {
    const Vector3d direction = direction_of(i);
    if (angle_between(direction, approach) > parameters.cone) continue;
    const auto way = way_along(direction, target, volume, vessels, markers, parameters, kept);
    if (way) all.push_back(*way);
  }
  if (all.empty()) return refuse(reason_of(kept));
  std::ranges::stable_sort(all, {}, &Way::cost);
  constexpr double kApart = 5 / kDegreesPerRad;
  std::vector<Way> best;
  for (const Way& way : all) {
    if (best.size() == static_cast<std::size_t>(parameters.ways)) break;
    const bool is_new = std::ranges::all_of(best, [&](const Way& other) {
      return angle_between((way.entry - target).normalized(),
                           (other.entry - target).normalized()) >= kApart;
    });
    if (is_new) best.push_back(way);
  }
  return best;
}

}  // namespace armature::image::needle_planner
