// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/scene/photo.hpp"
#include "armature/scene/right_camera.hpp"
#include "armature/scene/scene_renderer.hpp"
#include "sim_photo_scene_parameters.hpp"

// What the parameters say of the things before the cameras and of the cameras.
namespace armature::sim::photo_scene {

/// Throws SetupError for a photo that cannot be read, and for features that are not on it.
scene::Photo photo_of(const Parameters& parameters);

/// Throws SetupError for a head so small that the photo's eyes would come to lie on its back.
scene::Staging staging_of(const Parameters& parameters, const scene::Photo& photo);
scene::ImagingSettings imaging_of(const Parameters& parameters);
scene::RightCamera right_camera_of(const Parameters& parameters);

}  // namespace armature::sim::photo_scene
