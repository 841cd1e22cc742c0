// SPDX-License-Identifier: Apache-2.0
#include "orientations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "armature/robot/orientations/corner_blend.hpp"
#include "armature/runtime/plugins/plugin.hpp"

namespace armature::path::orientations {
namespace {

constexpr double kFewestParts = 8, kMaxParts = 50'000;  // of a path from key to key
constexpr double kRounding = 1e-6;                      // of a step

/// Orientation and position, and how far they go.
struct Curves {
  const OrientationCurve& orientation;
  BlendedPolyline position;

  /// The larger of turn and way from u to v, in steps.
  double steps(double u, double v, const Parameters& parameters) const {
    const double turn = orientation.at(u, Rates::none)
                            .rotation.angularDistance(orientation.at(v, Rates::none).rotation);
    return std::max(turn / parameters.step_rad,
                    (position.at(v) - position.at(u)).norm() / parameters.step_m);
  }
};

/// Into how many equal parts of u the way between two keys is cut, so that none is longer than a
/// step; more than kMaxParts when it cannot be done with fewer.
double parts_between(const Curves& curves, double from, double to, const Parameters& parameters) {
  double parts = kFewestParts;
  while (parts <= kMaxParts) {
    double longest = 0;
    for (double k = 0; k < parts; ++k) {
      longest = std::max(longest, curves.steps(std::lerp(from, to, k / parts),
                                               std::lerp(from, to, (k + 1) / parts), parameters));
    }
    if (longest <= 1 + kRounding) break;
    parts = std::ceil(parts * std::min(longest, kMaxParts));
  }
  return parts;
}

OrientationInterpolator interpolator_of(Parameters::Interpolator chosen) {
  switch (chosen) {
    case Parameters::Interpolator::slerp: return OrientationInterpolator::slerp;
    case Parameters::Interpolator::squad: return OrientationInterpolator::squad;
    case Parameters::Interpolator::rotvec_bspline: return OrientationInterpolator::rotvec_bspline;
    case Parameters::Interpolator::chart_bspline: break;
  }
  return OrientationInterpolator::chart_bspline;
}

}  // namespace

Expected<PathSegment> Orientations::along(const KeyPoses& keys,
                                          const OrientationCurve& curve) const {
  const std::vector<double>& u = curve.key_parameters();
  const Curves curves{curve, BlendedPolyline{keys.positions, u}};
  PathSegment segment;
  segment.space = PathSegment::Space::cartesian;
  segment.samples.push_back({0, keys.poses.front()});
  for (std::size_t i = 1; i < u.size(); ++i) {
    const double parts = parts_between(curves, u[i - 1], u[i], parameters_);
    if (static_cast<double>(segment.samples.size()) + parts > kMaxParts) {
      return refuse(
          fmt::format("the path would have more than {} samples of {:.3g} mm and {:.3g} "
                      "degrees",
                      kMaxParts, 1e3 * parameters_.step_m, parameters_.step_rad * 180 / M_PI));
    }
    for (double k = 1; k < parts; ++k) {
      const double s = std::lerp(u[i - 1], u[i], k / parts);
      segment.samples.push_back(
          {s, {curves.position.at(s), keys.told(curve.at(s, Rates::none).rotation)}});
    }
    segment.samples.push_back({u[i], keys.poses[i]});
  }
  return segment;
}

Expected<Path> Orientations::plan(const PathRequest& request) const {
  const auto valid = checked(request, {.key_poses = true});
  if (!valid) return tl::unexpected{valid.error()};
  const auto keys = key_poses_of(*valid);
  if (!keys) return tl::unexpected{keys.error()};
  if (keys->poses.size() == 1) {
    return Path{{.space = PathSegment::Space::joint,
                 .samples = {{.s = 1, .pose = valid->goal, .joints = valid->start_joints}},
                 .stop_at_end = true,
                 .duration_s = {}}};
  }
  const auto curve = OrientationCurve::through(
      keys->rotations, interpolator_of(parameters_.interpolator), key_parameters(*keys));
  if (!curve) {
    return refuse(curve.error().text + " (key 1 is the start; repeated poses are not counted)");
  }
  auto segment = along(*keys, *curve);
  if (!segment) return tl::unexpected{segment.error()};
  return Path{std::move(*segment)};
}

}  // namespace armature::path::orientations

ARMATURE_PLUGIN(armature::path::orientations::Orientations);
