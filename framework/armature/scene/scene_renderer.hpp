// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "armature/robot/geometry/stereo_camera.hpp"
#include "armature/scene/lens.hpp"
#include "armature/scene/occluder.hpp"
#include "armature/scene/photo.hpp"
#include "armature/scene/surface.hpp"

namespace armature::scene {

/// What stands before the cameras. As it is value-initialised: one flat photo, nothing else.
struct Staging {
  Surface surface = {};
  Occluder occluder = Occluder::none;
  /// Where the mouth of a second, equal face is [m], in the frame of the first one.
  std::optional<Eigen::Vector3d> second_face = {};
  double shadow = 0;  // 0 to 1: how much darker the photo is below the middle of the face
};

/// Renders faces, and what is held in front of them, into pinhole cameras.
class ARMATURE_EXPORT SceneRenderer {
 public:
  static constexpr int kWidestImage = Lens::kWidestImage;  // [px]

  /// The renderer keeps what it needs of `photo`. Allocates.
  SceneRenderer(const Photo& photo, const Staging& staging, const ImagingSettings& imaging,
                std::uint64_t seed);
  ~SceneRenderer();
  SceneRenderer(SceneRenderer&&) noexcept;
  SceneRenderer& operator=(SceneRenderer&&) noexcept;

  /// Draws `width * height` pixels of a camera with the intrinsics of `camera`. The face's frame:
  /// origin at the mouth, x to the photo's right, y down, z away from who looks at it.
  /// `brightness` multiplies every grey value; `picture` numbers the picture for its noise: same
  /// arguments, same bytes. Not real-time safe.
  void render(const Eigen::Isometry3d& camera_T_face, const StereoCamera& camera, double brightness,
              std::uint64_t picture, std::span<std::uint8_t> out);

  /// Where eyes and mouth of the first face are, in its own frame.
  const FacePoints& truth() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace armature::scene
