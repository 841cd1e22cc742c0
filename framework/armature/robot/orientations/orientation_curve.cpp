// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/orientations/orientation_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "armature/robot/geometry/rotation_vector.hpp"

namespace armature {
namespace {

using Keys = std::vector<Eigen::Quaterniond>;
using Vectors = std::vector<Eigen::Vector3d>;
using Pieces = std::variant<std::vector<ChartPiece>, std::vector<SquadPiece>>;

constexpr double kKeyLengthTolerance = 0.01;
// [rad] nearer to nothing or to half a turn, rounding decides the length or the way round.
constexpr double kAngleRounding = 1e-9;

struct PieceTable {
  std::vector<double> starts;
  Pieces pieces;
};

/// Unit keys, each of the sign that is nearer to the one before.
Expected<Keys> usable(std::span<const Eigen::Quaterniond> given) {
  if (given.size() < 2) {
    return refuse(fmt::format("an orientation curve needs two keys or more, not {}", given.size()));
  }
  Keys keys{given.begin(), given.end()};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const double length = keys[i].norm();
    if (!std::isfinite(length)) return refuse(fmt::format("key {} is not finite", i + 1));
    if (!(std::abs(length - 1) <= kKeyLengthTolerance)) {
      return refuse(fmt::format("key {} has length {:.6g}, not 1", i + 1, length));
    }
    keys[i].normalize();
    if (i == 0) continue;
    const double cosine = keys[i - 1].dot(keys[i]);
    if (std::abs(cosine) < 0.5 * kAngleRounding) {
      return refuse(fmt::format(
          "keys {} and {} are antipodal: half a turn apart, either way is as short", i, i + 1));
    }
    if (cosine < 0) keys[i].coeffs() = -keys[i].coeffs();
  }
  return keys;
}

/// The rotation vector from each key to the next, in the frame of either.
Vectors turns_between(const Keys& keys) {
  Vectors turns;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    turns.push_back(rotation_vector_of(keys[i - 1].conjugate() * keys[i]));
  }
  return turns;
}

/// Ascending from 0 to 1 in proportion to the lengths of the steps.
Expected<std::vector<double>> in_proportion(const Vectors& steps) {
  std::vector<double> u{0};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].norm() <= kAngleRounding) {
      return refuse(fmt::format("keys {} and {} are equal: they need parameters", i + 1, i + 2));
    }
    u.push_back(u.back() + steps[i].norm());
  }
  for (double& each : u) each /= u.back();
  return u;
}

Expected<std::vector<double>> fitting(std::span<const double> u, std::size_t keys) {
  if (u.size() != keys) return refuse(fmt::format("{} parameters for {} keys", u.size(), keys));
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (!std::isfinite(u[i])) return refuse(fmt::format("parameter {} is not finite", i + 1));
    if (i > 0 && !(u[i] > u[i - 1])) {
      return refuse(fmt::format("the parameters do not ascend from key {} to key {}", i, i + 1));
    }
  }
  return std::vector<double>{u.begin(), u.end()};
}

Vectors slopes_of(Vectors steps, std::span<const double> u) {
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i] /= u[i + 1] - u[i];
  return steps;
}

PieceTable slerp(const Keys& keys, const Vectors& slopes, std::span<const double> u) {
  std::vector<ChartPiece> pieces;
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    ChartPiece& piece = pieces.emplace_back(ChartPiece{keys[i], {}});
    piece.cubic.c.col(1) = slopes[i];
  }
  return {{u.begin(), u.end() - 1}, std::move(pieces)};
}

/// The blends, with the anchor of each key.
PieceTable charted(const std::vector<BlendPiece>& blends, const Keys& anchors) {
  PieceTable path;
  auto& pieces = path.pieces.emplace<std::vector<ChartPiece>>();
  for (const BlendPiece& blend : blends) {
    path.starts.push_back(blend.start);
    pieces.push_back({anchors[blend.key], blend.cubic});
  }
  return path;
}

/// The rotation vectors P = 2 ln q of the keys, in the base's chart.
Expected<Vectors> vectors_of(const Keys& keys) {
  Vectors points;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (std::abs(keys[i].w()) < 0.5 * kAngleRounding) {
      return refuse(fmt::format("key {} is half a turn: its rotation vector has two signs", i + 1));
    }
    points.push_back(rotation_vector_of(keys[i]));
  }
  return points;
}

Vectors steps_between(const Vectors& points) {
  Vectors steps;
  for (std::size_t i = 1; i < points.size(); ++i) steps.push_back(points[i] - points[i - 1]);
  return steps;
}

/// Three keys A, B, C as in the paper with m = 1: from A to D, about B, from E to C, a third each.
std::vector<BlendPiece> blends_of_the_paper(const Vectors& points) {
  const Eigen::Vector3d &A = points[0], &B = points[1], &C = points[2];
  const double l0 = 0.5 * std::min((A - B).norm(), (C - B).norm());
  const Eigen::Vector3d D = B + l0 * (A - B).normalized(), E = B + l0 * (C - B).normalized();
  constexpr double kThird = 1.0 / 3;
  std::vector<BlendPiece> pieces;
  append_line(pieces, 0, 0, A, (D - A) / kThird);
  append_corner(pieces, kThird, 1, corner_controls(D, B, E, D - A, C - E), kThird);
  append_line(pieces, 2 * kThird, 1, E, (C - E) / kThird);
  return pieces;
}

/// The velocity at a key is that of its neighbours' turns together over their time; an inner point
/// of either side follows from it. With even parameters both are the usual one,
/// q exp(-(log to the next + log to the one before) / 4); none is more than a quarter turn away.
PieceTable squad(const Keys& keys, const Vectors& turns, std::span<const double> u) {
  const std::size_t last = keys.size() - 1;
  Keys into = keys, out_of = keys;  // inner points of the interval before and behind a key
  for (std::size_t i = 1; i < last; ++i) {
    const double before = u[i] - u[i - 1], behind = u[i + 1] - u[i];
    const Eigen::Vector3d velocity = (turns[i - 1] + turns[i]) / (before + behind);
    const Eigen::Vector3d to_out = 0.5 * (behind * velocity - turns[i]);
    const Eigen::Vector3d to_into = 0.5 * (turns[i - 1] - before * velocity);
    out_of[i] = keys[i] * rotation_of(to_out);
    into[i] = keys[i] * rotation_of(to_into);
  }
  std::vector<SquadPiece> pieces;
  for (std::size_t i = 0; i < last; ++i) {
    pieces.emplace_back(keys[i], out_of[i], into[i + 1], keys[i + 1], u[i + 1] - u[i]);
  }
  return {{u.begin(), u.end() - 1}, std::move(pieces)};
}

constexpr std::array kNames{
    std::pair{std::string_view{"slerp"}, OrientationInterpolator::slerp},
    std::pair{std::string_view{"squad"}, OrientationInterpolator::squad},
    std::pair{std::string_view{"rotvec_bspline"}, OrientationInterpolator::rotvec_bspline},
    std::pair{std::string_view{"chart_bspline"}, OrientationInterpolator::chart_bspline}};

}  // namespace

std::optional<OrientationInterpolator> orientation_interpolator(std::string_view name) {
  for (const auto& [known, interpolator] : kNames) {
    if (known == name) return interpolator;
  }
  return std::nullopt;
}

Expected<OrientationCurve> OrientationCurve::through(std::span<const Eigen::Quaterniond> given,
                                                     OrientationInterpolator interpolator,
                                                     std::span<const double> u) {
  const auto keys = usable(given);
  if (!keys) return tl::unexpected{keys.error()};
  const bool in_base = interpolator == OrientationInterpolator::rotvec_bspline;
  Vectors points(keys->size(), Eigen::Vector3d::Zero());  // of each key in its own chart
  if (in_base) {
    auto vectors = vectors_of(*keys);
    if (!vectors) return tl::unexpected{vectors.error()};
    points = std::move(*vectors);
  }
  const Vectors steps = in_base ? steps_between(points) : turns_between(*keys);
  const auto parameters = u.empty() ? in_proportion(steps) : fitting(u, keys->size());
  if (!parameters) return tl::unexpected{parameters.error()};
  const auto made = [&](PieceTable path, std::vector<double> key_parameters) {
    return OrientationCurve{std::move(key_parameters), std::move(path.starts),
                            std::move(path.pieces)};
  };
  const Keys base(keys->size(), Eigen::Quaterniond::Identity());
  if (in_base && u.empty() && keys->size() == 3) {
    return made(charted(blends_of_the_paper(points), base), {0, 0.5, 1});
  }
  const Vectors slopes = slopes_of(steps, *parameters);
  switch (interpolator) {
    case OrientationInterpolator::slerp:
      return made(slerp(*keys, slopes, *parameters), *parameters);
    case OrientationInterpolator::squad: return made(squad(*keys, steps, *parameters), *parameters);
    case OrientationInterpolator::rotvec_bspline:
    case OrientationInterpolator::chart_bspline: break;
  }
  return made(charted(blend_pieces(points, slopes, *parameters), in_base ? base : *keys),
              *parameters);
}

OrientationCurve::OrientationCurve(std::vector<double> u, std::vector<double> starts, Pieces pieces)
    : u_{std::move(u)}, starts_{std::move(starts)}, pieces_{std::move(pieces)} {}

template <Rates rates>
OrientationState OrientationCurve::sample(double u) const {
  u = std::clamp(u, u_.front(), u_.back());
  const std::size_t i = piece_at(starts_, u);
  const double x = u - starts_[i];
  if (const auto* charts = std::get_if<std::vector<ChartPiece>>(&pieces_)) {
    return (*charts)[i].at<rates>(x);
  }
  const double end = i + 1 < starts_.size() ? starts_[i + 1] : u_.back();
  return std::get<std::vector<SquadPiece>>(pieces_)[i].at<rates>(x / (end - starts_[i]));
}

OrientationState OrientationCurve::at(double u, Rates rates) const {
  switch (rates) {
    case Rates::none: return sample<Rates::none>(u);
    case Rates::velocity: return sample<Rates::velocity>(u);
    case Rates::acceleration: break;
  }
  return sample<Rates::acceleration>(u);
}

}  // namespace armature
