// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "armature/kinds/face_picture.hpp"
#include "armature/robot/geometry/stereo_camera.hpp"
#include "armature/scene/generated_face.hpp"
#include "armature/scene/scene_renderer.hpp"

// A drawn face before two cameras, for the laws and the tests of what looks at faces.
namespace armature {

inline const StereoCamera kDrawnCamera{
    .width = 1280, .height = 720, .focal_px = 914, .cx = 639.5, .cy = 359.5, .baseline_m = 0.12};

struct DrawnPair {
  Picture left, right;
};

/// The pictures that both cameras take of a drawn face with eyes 63 mm apart, 65 mm above the
/// mouth, which is the origin of its frame (x to the picture's right, y down, z into the face).
inline DrawnPair drawn_face(const Eigen::Isometry3d& left_T_face, double brightness = 1) {
  static const auto photo = scene::generated_face(1, 0.063);
  static scene::SceneRenderer renderer{
      photo, {}, {.noise = 2, .blur_px = 0.5, .background = 120}, 1};
  const Picture black = Picture::of_one_grey(0, kDrawnCamera.width, kDrawnCamera.height);
  DrawnPair pair{black, black};
  Eigen::Isometry3d right_T_face = left_T_face;
  right_T_face.pretranslate(Eigen::Vector3d{-kDrawnCamera.baseline_m, 0, 0});
  renderer.render(left_T_face, kDrawnCamera, brightness, 0, pair.left.pixels);
  renderer.render(right_T_face, kDrawnCamera, brightness, 1, pair.right.pixels);
  return pair;
}

/// left_T_face of a mouth at (x, y, z) [m], the face turned by `pitch` about x, then by `yaw` about
/// y [rad]; without both it looks at the camera's plane.
inline Eigen::Isometry3d placed(double x, double y, double z, double yaw = 0, double pitch = 0) {
  return Eigen::Translation3d{x, y, z} * (Eigen::AngleAxisd{yaw, Eigen::Vector3d::UnitY()} *
                                          Eigen::AngleAxisd{pitch, Eigen::Vector3d::UnitX()});
}

/// What the laws of detectors and landmark finders look at: one face from the front, half a metre
/// away. `middle` [px] is half-way from its mouth to its eyes, `box` is as a detector sees it.
struct DrawnPortrait {
  Picture picture = drawn_face(placed(0.06, 0, 0.5)).left;
  Eigen::Vector2d middle = kDrawnCamera.project_left({0.06, -0.03, 0.5});
  PixelBox box{640, 190, 220, 220};
};

}  // namespace armature
