// SPDX-License-Identifier: Apache-2.0
#include "bench/plan/motions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "bench/random_joints.hpp"

namespace armature::bench {
namespace {

constexpr int kWaypoints = 20;
constexpr double kBow = 0.2;  // of a curve: off the straight line at its middle, as part of a range

/// Half a wave beside the straight line, so that limits are kept where the ends keep them by far.
JointSegment curve(const RobotModel& model, const JointVector& from, const JointVector& to,
                   std::mt19937_64& random) {
  JointVector bow(model.dof());
  for (int i = 0; i < model.dof(); ++i) {
    const auto [lower, upper] = range(model, i);
    bow[i] = kBow * (2 * unit(random) - 1) * (upper - lower);
  }
  JointSegment segment;
  for (int k = 0; k < kWaypoints; ++k) {
    const double s = static_cast<double>(k) / (kWaypoints - 1);
    segment.s.push_back(s);
    segment.q.push_back((1 - s) * from + s * to + std::sin(std::numbers::pi * s) * bow);
  }
  segment.q.back() = to;
  return segment;
}

}  // namespace

std::string_view to_string(Shape shape) {
  return shape == Shape::point_to_point ? "point to point" : "curve through 20";
}

double min_time(double way, double max_velocity, double max_acceleration) {
  const double distance = std::abs(way);
  if (distance * max_acceleration < max_velocity * max_velocity) {
    return 2 * std::sqrt(distance / max_acceleration);
  }
  return distance / max_velocity + max_velocity / max_acceleration;
}

std::vector<Motion> motions(const RobotModel& model, Shape shape, int count, std::uint64_t seed) {
  std::mt19937_64 random{seed};
  std::vector<Motion> list(static_cast<std::size_t>(count));
  for (Motion& motion : list) {
    const JointVector from = anywhere(model, random), to = anywhere(model, random);
    const JointVector zero = JointVector::Zero(model.dof());
    motion.request = {.goal_id = 1,
                      .start = {},
                      .from = {from, zero, zero},
                      .max_velocity = model.max_velocity(),
                      .max_acceleration = model.max_acceleration()};
    motion.request.segments.push_back(shape == Shape::point_to_point
                                          ? JointSegment{.s = {0, 1}, .q = {from, to}}
                                          : curve(model, from, to, random));
    for (int i = 0; i < model.dof(); ++i) {
      motion.min_s = std::max(motion.min_s, min_time(to[i] - from[i], model.max_velocity()[i],
                                                     model.max_acceleration()[i]));
    }
  }
  return list;
}

}  // namespace armature::bench
