// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "alignment.hpp"
#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/values/expected.hpp"
#include "face_frame.hpp"
#include "face_pose_surface_parameters.hpp"

// What must hold before a pose is believed. Each guard answers with the first thing that does not,
// its value and its limit.
namespace armature::face_pose::surface {

/// Pictures of the camera's size, and landmarks that are numbers.
Expected<void> input_is_sound(const FacePoseInput& input);

/// Eyes and mouth lie in the picture and apart; so what is computed for a face is bounded.
Expected<void> face_is_in_picture(const Features& features, const StereoCamera& camera);

/// Both pictures show the same face, as bright, and it bulges.
Expected<void> pictures_agree(const Alignment& aligned, const StereoCamera& camera,
                              const Parameters& parameters);

/// A feature at `at` [px] looks alike to both cameras and lies on the face; `own`: its surroundings
/// aligned alone, `aligned`: the whole face.
Expected<void> feature_is_uncovered(const char* name, const Eigen::Vector2d& at,
                                    const Alignment& own, const Alignment& aligned,
                                    const StereoCamera& camera, const Parameters& parameters);

/// No eye turns away from the camera on a narrow head; `left` and `right`: the surfaces around the
/// eyes.
Expected<void> eyes_face_the_camera(const Features& features, const DisparitySurface& left,
                                    const DisparitySurface& right, const StereoCamera& camera);

/// The rows of both pictures are the same.
Expected<void> pictures_are_rectified(const Alignment& aligned, const StereoCamera& camera,
                                      const Parameters& parameters);

/// A face of a person, near enough, seen from its front, and known well enough.
Expected<void> face_is_believable(const FacePose& face, const Parameters& parameters);

}  // namespace armature::face_pose::surface
