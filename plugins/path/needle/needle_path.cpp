// SPDX-License-Identifier: Apache-2.0
#include "needle_path.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/angles.hpp"

namespace armature::path::needle {
namespace {

using Eigen::Vector3d;

constexpr double kMaxSteps = 50000;  // on a line: far more than any needle's

Vector3d axis_of(const ToolPose& pose) {
  const auto* direction = std::get_if<Direction>(&pose.orientation);
  return direction ? direction->unit
                   : std::get<Eigen::Quaterniond>(pose.orientation) * Vector3d::UnitZ();
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

/// Places on it are told by their distance behind the entry [m]; before the entry they are
/// negative.
struct NeedlePath::Line {
  Vector3d entry, along;  // along: unit, into the head

  double at(const Vector3d& point) const { return along.dot(point - entry); }
  Vector3d point(double at) const { return entry + at * along; }
  double off(const Vector3d& position) const { return (position - point(at(position))).norm(); }
};

/// Through the goal along its axis; the entry must be on it.
Expected<NeedlePath::Line> NeedlePath::line_of(const PathRequest& request) const {
  if (!request.focus) {
    return refuse("there is no entry: a goal for a needle names it as the point to look at");
  }
  const Line through_goal{request.goal.position, axis_of(request.goal)};
  const double off = through_goal.off(*request.focus);
  if (off > parameters_.on_line_m) {
    return refuse(
        fmt::format("the needle's line passes the entry at {:.3f} mm, {:g} mm are allowed "
                    "(on_line_mm)",
                    1e3 * off, 1e3 * parameters_.on_line_m));
  }
  // What is left of `off` would be a step where the straight segments meet.
  return Line{through_goal.point(through_goal.at(*request.focus)), through_goal.along};
}

bool NeedlePath::is_on(const Line& line, const ToolPose& pose) const {
  return line.off(pose.position) <= parameters_.on_line_m &&
         angle_between(axis_of(pose), line.along) <= parameters_.on_line_rad;
}

std::optional<std::string> NeedlePath::obstacle(const Line& line, double from, double to,
                                                const PathRequest& request) const {
  for (const ForbiddenZone& zone : request.forbidden) {
    if (zone.tool_enters) continue;
    const double left =
        clearance(line.point(from), line.point(to), zone) - parameters_.needle_radius;
    if (left >= parameters_.margin) continue;
    return fmt::format("the needle leaves {:.2f} mm to '{}', {:g} mm are required (margin_mm)",
                       1e3 * left, zone.name, 1e3 * parameters_.margin);
  }
  return std::nullopt;
}

std::optional<std::string> NeedlePath::near_stand_off(const Line& line,
                                                      const PathRequest& request) const {
  const Vector3d stand_off = line.point(-parameters_.stand_off);
  for (const ForbiddenZone& zone : request.forbidden) {
    if (!zone.tool_enters) continue;
    const double left = clearance(stand_off, stand_off, zone) - parameters_.needle_radius;
    if (left >= parameters_.margin) continue;
    return fmt::format(
        "the needle leaves {:.2f} mm to '{}' at its stand-off, {:g} mm before the entry, {:g} mm "
        "are required (margin_mm): is the entry on the side that it comes from, and stand_off_mm "
        "large enough?",
        1e3 * left, zone.name, 1e3 * parameters_.stand_off, 1e3 * parameters_.margin);
  }
  return std::nullopt;
}

std::optional<std::string> NeedlePath::entered_before(const Line& line, double from,
                                                      const PathRequest& request) const {
  constexpr double kRounding_m = 1e-9;
  for (const ForbiddenZone& zone : request.forbidden) {
    if (!zone.tool_enters) continue;
    const auto left_from = [&](double at) {
      return clearance(line.point(at), line.entry, zone) - parameters_.needle_radius;
    };
    // It may come as near as the entry itself is, and into the zone there.
    const double allowed = std::min(parameters_.margin, left_from(0));
    const double nearest = left_from(from);
    if (nearest >= allowed - kRounding_m) continue;
    return fmt::format(
        "the needle leaves {:.2f} mm to '{}' on its way to the entry, {:.2f} mm are required: the "
        "entry is not where it comes in",
        1e3 * nearest, zone.name, 1e3 * allowed);
  }
  return std::nullopt;
}

PathSample NeedlePath::sample(const Line& line, double at, double s, const ToolPose& goal) const {
  PathSample sample{.s = s, .pose = goal};
  sample.pose.position = line.point(at);
  if (parameters_.needle_at_entry > 0) {
    sample.redundancy = Redundancy{.value = parameters_.needle_at_entry + at, .is_length = true};
  }
  return sample;
}

PathSegment NeedlePath::straight(const Line& line, double from, double to,
                                 const ToolPose& goal) const {
  const int steps =
      std::max(1, static_cast<int>(std::ceil(std::abs(to - from) / parameters_.step)));
  PathSegment segment;
  for (int i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    segment.samples.push_back(sample(line, from + s * (to - from), s, goal));
  }
  return segment;
}

Expected<Path> NeedlePath::plan(const PathRequest& request) const {
  const auto valid = checked(request, {.zones = true});
  if (!valid) return tl::unexpected{valid.error()};
  const auto line = line_of(*valid);
  if (!line) return tl::unexpected{line.error()};
  const double goal = line->at(valid->goal.position), here = line->at(valid->start.position);
  const bool on_line = is_on(*line, valid->start);
  const double begin = on_line ? here : -parameters_.stand_off;
  if (std::abs(goal - begin) > kMaxSteps * parameters_.step) {
    return refuse(
        fmt::format("the way along the line is {:.4g} m, more than {:g} steps of {:g} mm "
                    "(step_mm)",
                    std::abs(goal - begin), kMaxSteps, 1e3 * parameters_.step));
  }
  // The way back is the way that the needle came: nothing on it is nearer than it is now.
  const bool goes_in = !on_line || goal >= begin;
  if (goes_in) {
    const double from = std::min({begin, goal, -parameters_.stand_off});
    if (auto wrong = obstacle(*line, from, std::max(begin, goal), *valid)) {
      return refuse(std::move(*wrong));
    }
  }
  if (parameters_.needle_at_entry > 0 && parameters_.needle_at_entry + std::min(begin, goal) < 0) {
    return refuse(
        fmt::format("the needle starts {:g} mm before the entry and would have to be {:g} "
                    "mm shorter than nothing (needle_at_entry_m)",
                    -1e3 * std::min(begin, goal),
                    -1e3 * (parameters_.needle_at_entry + std::min(begin, goal))));
  }
  Path path;
  if (!on_line) {
    const double aside = line->off(valid->start.position);
    if (here > parameters_.on_line_m && aside < parameters_.stand_off) {
      return refuse(
          fmt::format("the tip is {:.1f} mm past the entry and {:.1f} mm beside the line: "
                      "it has to be drawn back first",
                      1e3 * here, 1e3 * aside));
    }
    if (auto wrong = near_stand_off(*line, *valid)) return refuse(std::move(*wrong));
    path.push_back({.space = PathSegment::Space::joint,
                    .samples = {sample(*line, begin, 1, valid->goal)},
                    .stop_at_end = true,
                    .duration_s = {}});
  }
  if (goes_in && begin < -parameters_.on_line_m) {
    if (auto wrong = entered_before(*line, begin, *valid)) return refuse(std::move(*wrong));
  }
  // A stop at the entry, whichever way it is passed.
  const bool passes_entry = std::min(begin, goal) < -parameters_.on_line_m &&
                            std::max(begin, goal) > parameters_.on_line_m;
  if (passes_entry) path.push_back(straight(*line, begin, 0, valid->goal));
  path.push_back(straight(*line, passes_entry ? 0 : begin, goal, valid->goal));
  if (on_line) path.front().samples.front().pose = valid->start;
  path.back().samples.back().pose = valid->goal;
  return path;
}

}  // namespace armature::path::needle

ARMATURE_PLUGIN(armature::path::needle::NeedlePath);
