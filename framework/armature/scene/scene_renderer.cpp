// SPDX-License-Identifier: Apache-2.0
#include "armature/scene/scene_renderer.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "armature/scene/photo_layer.hpp"
#include "armature/scene/view.hpp"

namespace armature::scene {
namespace {

constexpr double kShadowEdge = 0.15;  // width of the shadow's edge, in distances of eyes and mouth

/// The photo with its lower half in the dark, from between eyes and mouth on.
Photo shadowed(Photo photo, double darkness) {
  if (darkness <= 0) return photo;
  const double eyes = 0.5 * (photo.left_eye + photo.right_eye).y();
  const double height = photo.mouth.y() - eyes;
  std::size_t i = 0;
  for (int v = 0; v < photo.image.height; ++v) {
    const double below = (v - (eyes + 0.5 * height)) / (kShadowEdge * height);
    const double light = 1 - darkness * std::clamp(below + 0.5, 0.0, 1.0);
    for (int u = 0; u < photo.image.width; ++u, ++i) {
      photo.image.pixels[i] = static_cast<std::uint8_t>(photo.image.pixels[i] * light + 0.5);
    }
  }
  return photo;
}

PixelRegion both(const PixelRegion& a, const PixelRegion& b) {
  if (a.empty() || b.empty()) return a.empty() ? b : a;
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right),
          std::max(a.bottom, b.bottom)};
}

PixelRegion draw_occluder(Canvas& canvas, const View& view, const OccluderBody& body) {
  const auto [low, high] = body.box();
  std::array<Eigen::Vector3d, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = {(i & 1 ? high : low).x(), (i & 2 ? high : low).y(), (i & 4 ? high : low).z()};
  }
  const PixelRegion region = covered(view, corners);
  draw_by_rays(canvas, view, region, 2, [&](const Ray& ray) { return body.grey(ray); });
  return region;
}

}  // namespace

struct SceneRenderer::Parts {
  FacePoints truth;
  PhotoLayer photo;
  OccluderBody occluder;
  std::optional<Eigen::Vector3d> second_face;
  double background;
  Lens lens;
  Canvas canvas;
};

SceneRenderer::SceneRenderer(const Photo& photo, const Staging& staging,
                             const ImagingSettings& imaging, std::uint64_t seed)
    : parts_{std::make_unique<Parts>(
          Parts{.truth = face_points(photo, staging.surface),
                .photo = PhotoLayer{shadowed(photo, staging.shadow), staging.surface},
                .occluder = OccluderBody{staging.occluder, photo},
                .second_face = staging.second_face,
                .background = imaging.background,
                .lens = Lens{imaging, seed}})} {}
SceneRenderer::~SceneRenderer() = default;
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;

const FacePoints& SceneRenderer::truth() const { return parts_->truth; }

// From what is far to what is near: an occluder lies in front of its face for every camera that
// sees the face from the front. From behind the head hides it.
void SceneRenderer::render(const Eigen::Isometry3d& camera_T_face, const StereoCamera& camera,
                           double brightness, std::uint64_t picture, std::span<std::uint8_t> out) {
  auto& [truth, photo, occluder, second_face, background, lens, canvas] = *parts_;
  canvas.width = camera.width;
  canvas.height = camera.height;
  canvas.pixels.assign(
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height),
      static_cast<float>(background * brightness));
  const View view{camera_T_face, camera, brightness};
  PixelRegion drawn;
  const auto draw_second = [&] {
    View second = view;
    second.camera_T_face.translate(*second_face);
    drawn = both(drawn, photo.draw(canvas, second));
  };
  const bool second_is_far =
      second_face && (camera_T_face * *second_face).z() >= camera_T_face.translation().z();
  if (second_face && second_is_far) draw_second();
  drawn = both(drawn, photo.draw(canvas, view));
  const bool from_front = camera_T_face.inverse().translation().z() < 0;
  if (from_front && !occluder.empty()) drawn = both(drawn, draw_occluder(canvas, view, occluder));
  if (second_face && !second_is_far) draw_second();
  lens.blur(canvas, drawn);
  lens.expose(canvas, picture, out);
}

}  // namespace armature::scene
