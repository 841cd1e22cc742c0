// SPDX-License-Identifier: Apache-2.0
#include "armature/scene/generated_face.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace armature::scene {
namespace {

// The face is drawn in millimetres for eyes 63 mm apart: x to the right, y down, origin between the
// eyes. Proportions of an adult's face.
constexpr double kEyeDistance = 63.0;
constexpr double kMouthY = 65.0;
constexpr double kMmPerPx = 0.45;
constexpr double kLeft = -135, kTop = -140, kWidth = 270, kHeight = 330;

struct Point {
  double x, y;
};

/// 0 outside, 1 inside, with a soft edge `softness` wide.
double soft(double signed_distance, double softness) {
  const double t = std::clamp(0.5 - signed_distance / softness, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// How much of an ellipse covers p, [0, 1]; softness in mm.
double ellipse(Point p, Point centre, double rx, double ry, double softness, double turn = 0) {
  const double c = turn == 0 ? 1 : std::cos(turn), s = turn == 0 ? 0 : std::sin(turn);
  const double dx = p.x - centre.x, dy = p.y - centre.y;
  const double x = (c * dx + s * dy) / rx, y = (-s * dx + c * dy) / ry;
  const double radius = std::min(rx, ry);
  // Most points lie far outside, which is seen without a square root.
  if ((std::max(std::abs(x), std::abs(y)) - 1) * radius > softness / 2) return 0;
  return soft((std::hypot(x, y) - 1) * radius, softness);
}

double mix(double a, double b, double share) { return a + (b - a) * share; }

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

double draw_hair_and_body(Point p) {
  double value = mix(150, 135, std::clamp((p.y - kTop) / kHeight, 0.0, 1.0));  // wall
  value = mix(value, 70, ellipse(p, {0, 215}, 125, 75, 6));                    // shoulders
  value = mix(value, 128, ellipse(p, {0, 118}, 46, 75, 10));                   // neck
  value = mix(value, 42, ellipse(p, {0, -18}, 88, 104, 8));                    // hair
  return value;
}

double draw_head(Point p, double value) {
  const double ears = std::max(ellipse(p, {-75, 18}, 10, 24, 4), ellipse(p, {75, 18}, 10, 24, 4));
  value = mix(value, 150, ears);
  // Skull and jaw together; brighter in the middle as if lit from the front.
  const double face = std::max(ellipse(p, {0, 4}, 71, 80, 4), ellipse(p, {0, 44}, 60, 71, 4));
  const double edge = std::hypot(p.x / 74, (p.y - 20) / 105);
  const double skin = 196 - 58 * edge * edge;
  value = mix(value, skin, face);
  // Hairline: hair over the forehead.
  const double fringe =
      soft(p.y + 62 + 14 * std::cos(p.x / 38), 8) * ellipse(p, {0, -18}, 84, 100, 6);
  return mix(value, 45, fringe);
}

double draw_eye(Point p, double side, double value) {
  const Point centre{side * kEyeDistance / 2, 0};
  const double x = (p.x - centre.x) * side, y = p.y;  // x grows away from the nose
  value = mix(value, 138, 0.75 * ellipse(p, {centre.x, -3}, 23, 14, 16));  // eye socket
  // The opening: between two arcs that meet at the corners, 15 mm from the centre.
  const double t = std::clamp(1 - (x * x) / (15.0 * 15.0), 0.0, 1.0);
  const double upper = -6.0 * std::pow(t, 0.75), lower = 6.0 * std::pow(t, 0.9);
  const double open = soft(std::max(upper - y, y - lower), 1.2) * soft(std::abs(x) - 15.0, 1.0);
  double eyeball = mix(216, 168, std::clamp(std::abs(x) / 15 - 0.3, 0.0, 1.0));
  eyeball = mix(eyeball, 72, ellipse(p, centre, 6.1, 6.1, 1.0));
  eyeball = mix(eyeball, 18, ellipse(p, centre, 2.7, 2.7, 0.8));
  eyeball = mix(eyeball, 245, ellipse(p, {centre.x - 2.2, -2.2}, 1.0, 1.0, 0.6));
  value = mix(value, eyeball, open);
  // Lashes on the upper rim, a thin rim below, the fold of the lid.
  const double near_corner = soft(std::abs(x) - 15.6, 1.5);
  value = mix(value, 40, 0.9 * near_corner * soft(std::abs(y - upper + 0.4) - 1.1, 1.2));
  value = mix(value, 96, 0.7 * near_corner * soft(std::abs(y - lower - 0.2) - 0.5, 1.2));
  value = mix(value, 112, 0.6 * near_corner * soft(std::abs(y - upper + 4.6) - 0.5, 1.6));
  // The brow.
  const double brow = -19.5 + 0.012 * (x - 6) * (x - 6);
  return mix(value, 52, 0.92 * soft(std::abs(y - brow) - 2.6, 2.4) * soft(std::abs(x - 1) - 20, 6));
}

double draw_nose(Point p, double value) {
  const double ridge = std::clamp((p.y + 4) / 46, 0.0, 1.0);
  const double below = soft(p.y - 44, 8);
  const double flank = soft(std::abs(std::abs(p.x) - (6 + 7 * ridge)) - 1.5, 7);
  value = mix(value, 128, 0.55 * flank * below * soft(-p.y - 2, 10));
  value = mix(value, 214, 0.6 * ellipse(p, {0, 22}, 4.5, 22, 6));  // ridge
  value = mix(value, 208, 0.7 * ellipse(p, {0, 36}, 8, 6.5, 6));   // tip
  for (const double side : {-1.0, 1.0}) {
    value = mix(value, 112, 0.7 * ellipse(p, {side * 15, 39}, 3.2, 7, 4));  // wing
    value = mix(value, 44, 0.95 * ellipse(p, {side * 7.5, 45}, 4.2, 2.1, 1.8, side * 0.25));
  }
  value = mix(value, 122, 0.6 * ellipse(p, {0, 47.5}, 9, 1.6, 3));
  return mix(value, 150, 0.5 * ellipse(p, {0, 53.5}, 2.6, 4.5, 4));  // philtrum
}

double draw_mouth(Point p, double value) {
  const double x = p.x, y = p.y - kMouthY;
  const double t = std::clamp(1 - (x * x) / (25.0 * 25.0), 0.0, 1.0);
  const double bow = 1.6 * std::exp(-(x * x) / 18.0);
  const double top = -7.2 * std::pow(t, 0.8) + bow, bottom = 9.6 * std::pow(t, 0.8);
  const double within = soft(std::abs(x) - 25.0, 1.5);
  value = mix(value, 128, 0.6 * ellipse(p, {0, kMouthY + 14.5}, 17, 3.2, 6));  // under the lip
  value = mix(value, 108, within * soft(std::max(top - y, y), 1.4));
  value = mix(value, 134, within * soft(std::max(-y, y - bottom), 1.4));
  value = mix(value, 160, 0.7 * ellipse(p, {0, kMouthY + 5}, 11, 2.4, 4));  // shine
  value = mix(value, 38, soft(std::abs(x) - 24.5, 3) * soft(std::abs(y) - 0.75, 1.3));
  for (const double side : {-1.0, 1.0}) {
    value = mix(value, 84, 0.7 * ellipse(p, {side * 25.3, kMouthY}, 2.4, 2.0, 2.4));
    // Fold from the nose to the corner of the mouth.
    const double fold = side * (20 + 12 * std::pow(std::clamp((p.y - 40) / 30, 0.0, 1.0), 0.8));
    value = mix(value, 134,
                0.45 * soft(std::abs(p.x - fold) - 0.8, 4) * soft(std::abs(p.y - 54) - 12, 8));
  }
  return mix(value, 200, 0.35 * ellipse(p, {0, 92}, 15, 10, 14));  // chin
}

double draw(Point p, const SkinTexture& texture) {
  double value = draw_head(p, draw_hair_and_body(p));
  for (const double side : {-1.0, 1.0}) value = draw_eye(p, side, value);
  value = draw_mouth(p, draw_nose(p, value));
  value += 7.0 * texture(p, 1.3, 1) + 5.0 * texture(p, 3.1, 2) + 4.0 * texture(p, 9.0, 3);
  const double mole = texture(p, 4.0, 4);
  if (mole > 0.55) value -= 45 * (mole - 0.55);
  return value;
}

}  // namespace

Photo generated_face(std::uint64_t seed, double eye_distance_m) {
  const SkinTexture texture{seed};
  Photo photo;
  photo.image.width = static_cast<int>(kWidth / kMmPerPx);
  photo.image.height = static_cast<int>(kHeight / kMmPerPx);
  photo.image.pixels.reserve(static_cast<std::size_t>(photo.image.width) *
                             static_cast<std::size_t>(photo.image.height));
  for (int v = 0; v < photo.image.height; ++v) {
    for (int u = 0; u < photo.image.width; ++u) {
      const double value = draw({kLeft + u * kMmPerPx, kTop + v * kMmPerPx}, texture);
      photo.image.pixels.push_back(static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0) + 0.5));
    }
  }
  const auto pixel = [](double x, double y) {
    return Eigen::Vector2d{(x - kLeft) / kMmPerPx, (y - kTop) / kMmPerPx};
  };
  photo.left_eye = pixel(-kEyeDistance / 2, 0);
  photo.right_eye = pixel(kEyeDistance / 2, 0);
  photo.mouth = pixel(0, kMouthY);
  photo.m_per_px = eye_distance_m / kEyeDistance * kMmPerPx;
  return photo;
}

}  // namespace armature::scene
