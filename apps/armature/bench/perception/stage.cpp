// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/stage.hpp"

#include <optional>

#include "armature/scene/generated_face.hpp"

namespace armature::bench {
namespace {

constexpr double kEyeDistance_m = 0.063;

}  // namespace

const scene::Photo& Stage::photo(std::uint64_t face_seed) {
  const auto [at, is_new] = photos_.try_emplace(face_seed);
  if (is_new) at->second = scene::generated_face(face_seed, kEyeDistance_m);
  return at->second;
}

StagedPair Stage::take(const PerceptionCase& one) {
  const StereoCamera& camera = one.camera;
  scene::SceneRenderer renderer{photo(one.face_seed), one.staging, one.imaging, one.noise_seed};
  const Picture black = Picture::of_one_grey(0, camera.width, camera.height);
  StagedPair pair{black, black, renderer.truth().in(one.left_T_face)};
  renderer.render(one.left_shows, camera, one.brightness, 0, pair.left.pixels);
  std::optional<scene::SceneRenderer> other;
  if (one.right_face_seed) {
    other.emplace(photo(*one.right_face_seed), one.staging, one.imaging, one.noise_seed);
  }
  (other ? *other : renderer)
      .render(one.right.right_T_left(camera) * one.right_shows, one.right.of(camera),
              one.right.gain * one.brightness, 1, pair.right.pixels);
  return pair;
}

}  // namespace armature::bench
