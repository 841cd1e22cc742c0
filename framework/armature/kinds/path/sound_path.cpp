// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string_view>
#include <variant>

#include "armature/kinds/path/laws.hpp"

// What holds for every path, whatever it goes like.
namespace armature {
namespace {

constexpr double kRounding = 1e-9;  // [rad], and of a length

/// [rad]; infinite between a direction and a rotation.
double angle_between(const Orientation& a, const Orientation& b) {
  if (a.index() != b.index()) return std::numeric_limits<double>::infinity();
  if (const auto* rotation = std::get_if<Eigen::Quaterniond>(&a)) {
    return rotation->angularDistance(std::get<Eigen::Quaterniond>(b));
  }
  const Eigen::Vector3d &u = std::get<Direction>(a).unit, &v = std::get<Direction>(b).unit;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

/// `way` says between which two: "from the path's end to the goal".
void check_same(const ToolPose& a, const ToolPose& b, std::string_view way, LawCheck& check) {
  check.at_most((a.position - b.position).norm(), kRounding * (1 + b.position.norm()),
                fmt::format("{} [m]", way));
  check.at_most(angle_between(a.orientation, b.orientation), 10 * kRounding,
                fmt::format("{} [rad, infinite between a direction and a rotation]", way));
}

void check_finite_unit(const ToolPose& pose, LawCheck& check) {
  check.that(pose.position.allFinite(), "every sample's position is finite");
  const auto* direction = std::get_if<Direction>(&pose.orientation);
  const double length =
      direction ? direction->unit.norm() : std::get<Eigen::Quaterniond>(pose.orientation).norm();
  check.near(length, 1, kRounding, "the length of a sample's direction or quaternion");
}

void check_segment(const PathSegment& segment, const ToolPose& from, LawCheck& check) {
  if (segment.space == PathSegment::Space::cartesian) {
    if (!check.that(segment.samples.size() >= 2, "a cartesian segment has two samples or more")) {
      return;
    }
    check.equal(segment.samples.front().s, 0.0, "s of a cartesian segment's first sample");
    check_same(segment.samples.front().pose, from,
               "from a cartesian segment's first sample to where the way was before it", check);
  } else {
    if (!check.that(!segment.samples.empty(), "a joint segment has a sample")) return;
    check.that(segment.samples.front().s > 0,
               "a joint segment's first sample has s above 0: its start needs no sample");
  }
  check.equal(segment.samples.back().s, 1.0, "s of a segment's last sample");
  for (std::size_t i = 0; i < segment.samples.size(); ++i) {
    check_finite_unit(segment.samples[i].pose, check);
    if (i > 0) check.that(segment.samples[i].s > segment.samples[i - 1].s, "s rises in a segment");
  }
}

/// Every key pose is a sample, in their order.
void check_key_poses(const Path& path, const PathRequest& request, LawCheck& check) {
  std::size_t passed = 0;
  for (const PathSegment& segment : path) {
    for (const PathSample& sample : segment.samples) {
      if (passed == request.through.size()) return;
      const ToolPose& key = request.through[passed];
      const double off = (sample.pose.position - key.position).norm();
      if (off <= kRounding * (1 + key.position.norm()) &&
          angle_between(sample.pose.orientation, key.orientation) <= 10 * kRounding) {
        ++passed;
      }
    }
  }
  check.equal(passed, request.through.size(), "key poses that the path goes through in order");
}

}  // namespace

void check_sound(const Path& path, const PathRequest& request, LawCheck& check) {
  if (!check.that(!path.empty(), "a path has segments")) return;
  check_key_poses(path, request, check);
  ToolPose last = request.start;
  bool from_stop = true;
  for (const PathSegment& segment : path) {
    check_segment(segment, last, check);
    if (segment.samples.empty()) return;
    if (segment.duration_s) {
      check.that(*segment.duration_s > 0 && std::isfinite(*segment.duration_s),
                 "a segment's duration is above 0 s and finite");
      check.that(from_stop && segment.stop_at_end,
                 "a segment with a duration of its own goes from rest to rest");
    }
    from_stop = segment.stop_at_end;
    last = segment.samples.back().pose;
  }
  check.that(from_stop, "the path ends at rest");
  check_same(last, request.goal, "from the path's last sample to the goal", check);
}

}  // namespace armature
