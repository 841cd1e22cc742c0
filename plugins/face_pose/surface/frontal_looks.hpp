// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "armature/kinds/landmarks/landmarks.hpp"
#include "armature/values/expected.hpp"
#include "frontal_view.hpp"

namespace armature::face_pose::surface {

/// A feature as several looks at the frontal view find it.
struct SeenFeature {
  Eigen::Vector2d at;  // [px] of the view: the mean of the looks that count
  double sigma;        // [px] as the finder states it
  double moved;        // by which they differ at most, in distances of the eyes
};

/// The features of a frontal view, in the order of kFaceFeatures, from boxes that lie differently:
/// what a finder sees stays where it is when its box moves, what it makes up moves with the box.
/// There are two looks, from opposite corners. Where a feature moves by more than
/// `max_unsteadiness`, the other two corners are tried, and of each feature the look that is
/// farthest from the others is left out: any three corners of a square have two opposite ones among
/// them, so that what moves with the box moves as far as before, while a finder that went astray in
/// one look (behind glasses it does) is outvoted. With `tries_lower_boxes` the same is tried from
/// lower boxes where that does not help.
Expected<std::array<SeenFeature, 3>> look_at_features(FrontalView& view, LandmarkFinder& finder,
                                                      double max_unsteadiness,
                                                      bool tries_lower_boxes);

}  // namespace armature::face_pose::surface
