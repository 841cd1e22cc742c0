// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/finder_bias.hpp"

#include <algorithm>

#include "armature/values/guarded.hpp"

namespace armature::bench {
namespace {

constexpr int kPictures = 16;
constexpr StereoCamera kCamera{
    .width = 640, .height = 720, .focal_px = 914, .cx = 319.5, .cy = 359.5, .baseline_m = 0.12};

/// A frontal place near (0, 0, 0.5): 4 x 4 places whose pixels lie differently.
Eigen::Vector3d jittered(int i) {
  return {0.0027 * (i % 4 - 1.5), 0.03 + 0.0031 * (i / 4 - 1.5), 0.48 + 0.0025 * i};
}

}  // namespace

std::optional<FinderBias::Features> FinderBias::measure(const scene::Photo& photo) {
  scene::SceneRenderer renderer{photo, {}, {.noise = 0, .blur_px = 0, .background = 120}, 1};
  Picture picture = Picture::of_one_grey(0, kCamera.width, kCamera.height);
  const SearchRegion everywhere{.box = {0, 0, kCamera.width - 1.0, kCamera.height - 1.0}};
  Features sum{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  for (int i = 0; i < kPictures; ++i) {
    const Eigen::Vector3d mouth = jittered(i);
    renderer.render(Eigen::Isometry3d{Eigen::Translation3d{mouth}}, kCamera, 1, 0, picture.pixels);
    const auto faces = guarded([&] { return detector_.detect(picture.view(), everywhere); });
    if (!faces || faces->empty()) return std::nullopt;
    const auto largest = std::ranges::max_element(
        *faces, {}, [](const DetectedFace& face) { return face.box.width; });
    const auto points = guarded([&] { return finder_.find(picture.view(), largest->box); });
    if (!points || points->size() != landmark_count(finder_.scheme())) return std::nullopt;
    const FaceLandmarks face{.scheme = finder_.scheme(), .points = *points, .box = largest->box};
    const auto on_photo = [&](FaceFeature feature) -> Eigen::Vector2d {
      const Eigen::Vector2d pixel = face.feature(feature).point;
      return (pixel - Eigen::Vector2d{kCamera.cx, kCamera.cy}) * mouth.z() / kCamera.focal_px -
             mouth.head<2>();
    };
    sum.left_eye += on_photo(FaceFeature::left_eye);
    sum.right_eye += on_photo(FaceFeature::right_eye);
    sum.mouth += on_photo(FaceFeature::mouth);
  }
  return Features{sum.left_eye / kPictures, sum.right_eye / kPictures, sum.mouth / kPictures};
}

std::optional<scene::FacePoints> FinderBias::points(const PerceptionCase& one, Stage& stage) {
  const auto [at, is_new] = known_.try_emplace(one.face_seed);
  if (is_new) at->second = measure(stage.photo(one.face_seed));
  if (!at->second) return std::nullopt;
  const scene::Surface& surface = one.staging.surface;
  const scene::FacePoints in_face{surface.point(at->second->left_eye),
                                  surface.point(at->second->right_eye),
                                  surface.point(at->second->mouth)};
  return in_face.in(one.left_T_face);
}

}  // namespace armature::bench
