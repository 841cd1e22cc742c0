// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/kinds/detector/detector.hpp"
#include "armature/kinds/face_pose/face_pose.hpp"
#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/kinds/landmarks/stereo_face_finder.hpp"
#include "armature/robot/geometry/stereo_camera.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "run/run.hpp"

namespace armature::bench {

/// Plugins that are measured instead of the deployment's, by their ids, with their defaults; empty:
/// the deployment's, with its parameters. An id that the deployment has, too, keeps them.
struct PerceptionChoice {
  std::string detector, landmarks, face_pose;
};

/// The plugins of a deployment that look at faces, made as their hosts make them.
struct ChosenPerception {
  std::string deployment, rig, detector_id, landmarks_id, face_pose_id;
  StereoFaceFinder::Options search{};  // of the component that finds landmarks
  StereoCamera camera;
  PluginPtr<FaceDetector> detector;
  PluginPtr<LandmarkFinder> landmarks;
  PluginPtr<FacePoseEstimator> face_pose;
  PluginPtr<LandmarkFinder> frontal_landmarks;  // of the estimator; nullptr: it has none
};

/// Throws config::ConfigError for what is wrong in the files, InvalidChoice for an id that means
/// nothing here and for a deployment that finds no faces or has no cameras, and std::runtime_error
/// with the reason of a plugin that refuses its parameters.
ChosenPerception chosen_perception(PluginRegistry& plugins, const DeploymentSource& source,
                                   const PerceptionChoice& choice);

}  // namespace armature::bench
