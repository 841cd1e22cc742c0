// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

// What faces are drawn with: soft edges, ellipses, and the grain of skin. Lengths are in mm, x to
// the right, y down.
namespace armature::scene {

struct Point {
  double x, y;
};

/// 0 outside, 1 inside, with a soft edge `softness` wide.
inline double soft(double signed_distance, double softness) {
  const double t = std::clamp(0.5 - signed_distance / softness, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// How much of an ellipse covers p, [0, 1].
inline double ellipse(Point p, Point centre, double rx, double ry, double softness,
                      double turn = 0) {
  const double c = turn == 0 ? 1 : std::cos(turn), s = turn == 0 ? 0 : std::sin(turn);
  const double dx = p.x - centre.x, dy = p.y - centre.y;
  const double x = (c * dx + s * dy) / rx, y = (-s * dx + c * dy) / ry;
  const double radius = std::min(rx, ry);
  // Most points lie far outside, which is seen without a square root.
  if ((std::max(std::abs(x), std::abs(y)) - 1) * radius > softness / 2) return 0;
  return soft((std::hypot(x, y) - 1) * radius, softness);
}

inline double mix(double a, double b, double share) { return a + (b - a) * share; }

/// A smooth noise value in [-1, 1] at a grid of `cell` mm.
class SkinTexture {
 public:
  explicit SkinTexture(std::uint64_t seed) : seed_{seed} {}
  double operator()(Point p, double cell, std::uint64_t layer) const {
    const double x = p.x / cell, y = p.y / cell;
    const double fx = std::floor(x), fy = std::floor(y);
    const double u = fade(x - fx), v = fade(y - fy);
    const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy);
    return mix(mix(at(i, j, layer), at(i + 1, j, layer), u),
               mix(at(i, j + 1, layer), at(i + 1, j + 1, layer), u), v);
  }

 private:
  static double fade(double t) { return t * t * (3 - 2 * t); }
  double at(std::int64_t i, std::int64_t j, std::uint64_t layer) const {
    std::uint64_t h = seed_ + layer * 0x9e3779b97f4a7c15ULL +
                      static_cast<std::uint64_t>(i) * 0xbf58476d1ce4e5b9ULL +
                      static_cast<std::uint64_t>(j) * 0x94d049bb133111ebULL;
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
    h ^= h >> 31;
    return static_cast<double>(h >> 11) * 0x1p-52 - 1.0;
  }
  std::uint64_t seed_;
};

}  // namespace armature::scene
