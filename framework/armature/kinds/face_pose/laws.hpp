// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <ostream>
#include <span>
#include <string>

#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/laws/law.hpp"

// The laws that every `face_pose` plugin keeps.
namespace armature ARMATURE_EXPORT {

struct FacePoseSubject {
  std::string name;
  std::shared_ptr<FacePoseEstimator> estimator;

  friend void PrintTo(const FacePoseSubject& subject, std::ostream* out) { *out << subject.name; }
};

/// Landmarks of a flat face with eyes 63 mm apart, 65 mm above the mouth, without error, though a
/// sigma of 0.3 px is stated. The face's frame: origin at the mouth, x to the image's right, y
/// down, z into the face. All landmarks of a feature lie at its centre; the others at the mouth.
FacePoseInput exact_face(const StereoCamera& camera, const Eigen::Isometry3d& left_T_face);

std::span<const Law<FacePoseSubject>> face_pose_laws();

}  // namespace armature

// The laws by name: LAW(TheSentence, the_function, "in short").
#define ARMATURE_FACE_POSE_LAWS(LAW)                                                       \
  LAW(RecoversThePoseOfADrawnFaceFromExactLandmarks, recovers_pose,                        \
      "a drawn face with exact landmarks: its pose to 0.5 mm and 0.3 degrees")             \
  LAW(GivesTheSameBitsForTheSameInput, repeats_bits, "the same input gives the same bits") \
  LAW(RefusesLandmarksThatAreNoFace, refuses_no_face, "landmarks that are no face are refused")
