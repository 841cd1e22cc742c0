// SPDX-License-Identifier: Apache-2.0
#include "armature/scene/generated_face.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "armature/scene/drawing.hpp"
#include "armature/scene/face_traits.hpp"

namespace armature::scene {
namespace {

// The face is drawn in millimetres for eyes 63 mm apart: x to the right, y down, origin between the
// eyes. Proportions of an adult's face.
constexpr double kEyeDistance = 63.0;
constexpr double kMouthY = 65.0;
constexpr double kMmPerPx = 0.45;
constexpr double kLeft = -135, kTop = -140, kWidth = 270, kHeight = 330;

/// Where a feature can be seen [mm]. Elsewhere its share is 0, which changes no value: most of a
/// photo is elsewhere.
struct Extent {
  double beside, top, bottom;
  bool has(double x, double y) const { return std::abs(x) <= beside && y >= top && y <= bottom; }
};
constexpr Extent kEye{37, -26, 20}, kNose{21, -15, 62}, kMouth{36, 37, 110};

double draw_hair_and_body(Point p, const FaceTraits& traits) {
  double value = mix(150, 135, std::clamp((p.y - kTop) / kHeight, 0.0, 1.0));  // wall
  value = mix(value, 70, ellipse(p, {0, 215}, 125, 75, 6));                    // shoulders
  value = mix(value, 128 + traits.skin, ellipse(p, {0, 118}, 46, 75, 10));     // neck
  if (traits.is_bald) return value;
  return mix(value, 42 + traits.hair, ellipse(p, {0, -18}, 88, 104, 8));
}

double draw_head(Point p, const FaceTraits& traits, double value) {
  const double ears = std::max(ellipse(p, {-75, 18}, 10, 24, 4), ellipse(p, {75, 18}, 10, 24, 4));
  value = mix(value, 150 + traits.skin, ears);
  const double forehead = traits.is_bald ? ellipse(p, {0, -22}, 70, 80, 4) : 0.0;
  // Skull and jaw together; brighter in the middle as if lit from the front.
  const double face =
      std::max({forehead, ellipse(p, {0, 4}, 71, 80, 4), ellipse(p, {0, 44}, 60, 71, 4)});
  if (face > 0) {
    const double edge = std::hypot(p.x / 74, (p.y - 20) / 105);
    const double skin = 196 + traits.skin - 58 * edge * edge;
    value = mix(value, skin, face);
  }
  const double hair = traits.is_bald ? 0.0 : ellipse(p, {0, -18}, 84, 100, 6);
  if (hair == 0) return value;
  // Hairline: hair over the forehead.
  const double fringe = soft(p.y + 62 + 14 * std::cos(p.x / 38), 8) * hair;
  return mix(value, 45 + traits.hair, fringe);
}

double draw_eye(Point p, double side, double value) {
  const Point centre{side * kEyeDistance / 2, 0};
  const double x = (p.x - centre.x) * side, y = p.y;  // x grows away from the nose
  if (!kEye.has(x, y)) return value;
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
  if (!kNose.has(p.x, p.y)) return value;
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
  if (!kMouth.has(p.x, p.y)) return value;
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

/// Cheeks and chin, and what grows above the lip.
double draw_beard(Point p, const FaceTraits& traits, const SkinTexture& texture, double value) {
  const double jaw = ellipse(p, {0, 52}, 62, 66, 8) * soft(52 - p.y - 0.2 * std::abs(p.x), 14);
  const double lip = ellipse(p, {0, 55}, 28, 5, 5);
  const double hairs = 0.75 + 0.25 * texture(p, 1.6, 5);
  return mix(value, 60 + traits.hair, 0.85 * std::max(jaw, lip) * hairs);
}

double draw_glasses(Point p, double value) {
  constexpr double kRim = 1.5;
  const double x = std::abs(p.x);
  const Point lens{kEyeDistance / 2 + 1, 1};
  // Signed distances of the rim around a lens, of the bridge and of the temple.
  const double rx = 24, ry = 19;
  const double round = std::pow(
      std::pow(std::abs((x - lens.x) / rx), 3) + std::pow(std::abs((p.y - lens.y) / ry), 3),
      1.0 / 3);
  const double rim = std::abs((round - 1) * ry) - kRim;
  const double bridge = std::max(std::abs(p.y + 5) - kRim, x - (lens.x - rx));
  const double temple = std::max(std::abs(p.y + 4) - kRim, std::abs(x - 65) - 9);
  value = mix(value, 30, 0.95 * soft(std::min({rim, bridge, temple}), 1.2));
  return mix(value, 235, 0.12 * soft((round - 0.9) * ry, 3));  // the glass mirrors a little
}

/// The face in its own proportions: head and lower face are stretched, the eyes are not.
double draw(Point p, const FaceTraits& traits, const SkinTexture& texture) {
  const double stretch = p.y > 0 ? kMouthY / traits.eyes_to_mouth_mm : 1.0;
  const Point in_head{p.x / traits.width, p.y * stretch}, in_lower_face{p.x, p.y * stretch};
  double value = draw_head(in_head, traits, draw_hair_and_body(in_head, traits));
  for (const double side : {-1.0, 1.0}) value = draw_eye(p, side, value);
  value = draw_nose(in_lower_face, value);
  if (traits.has_beard) value = draw_beard(in_lower_face, traits, texture, value);
  value = draw_mouth(in_lower_face, value);
  if (traits.has_glasses) value = draw_glasses(p, value);
  value += 7.0 * texture(p, 1.3, 1) + 5.0 * texture(p, 3.1, 2) + 4.0 * texture(p, 9.0, 3);
  const double mole = texture(p, 4.0, 4);
  if (mole > 0.55) value -= 45 * (mole - 0.55);
  return value;
}

}  // namespace

Photo generated_face(std::uint64_t seed, double eye_distance_m) {
  const SkinTexture texture{seed};
  const FaceTraits traits = traits_of(seed);
  Photo photo;
  photo.image.width = static_cast<int>(kWidth / kMmPerPx);
  photo.image.height = static_cast<int>(kHeight / kMmPerPx);
  photo.image.pixels.reserve(static_cast<std::size_t>(photo.image.width) *
                             static_cast<std::size_t>(photo.image.height));
  for (int v = 0; v < photo.image.height; ++v) {
    for (int u = 0; u < photo.image.width; ++u) {
      const double value = draw({kLeft + u * kMmPerPx, kTop + v * kMmPerPx}, traits, texture);
      photo.image.pixels.push_back(static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0) + 0.5));
    }
  }
  const auto pixel = [](double x, double y) {
    return Eigen::Vector2d{(x - kLeft) / kMmPerPx, (y - kTop) / kMmPerPx};
  };
  photo.left_eye = pixel(-kEyeDistance / 2, 0);
  photo.right_eye = pixel(kEyeDistance / 2, 0);
  photo.mouth = pixel(0, traits.eyes_to_mouth_mm);
  photo.m_per_px = eye_distance_m / kEyeDistance * kMmPerPx;
  return photo;
}

}  // namespace armature::scene
