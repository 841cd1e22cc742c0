// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "alignment.hpp"
#include "armature/kinds/image_view.hpp"
#include "armature/values/expected.hpp"
#include "face_frame.hpp"

namespace armature::face_pose::surface {

/// Aligns a surface with a face in a stereo pair: a plane, from coarse pictures to fine ones, then
/// a quadric if the pixels ask for it. Keeps its memory from pair to pair.
class FaceFit {
 public:
  /// The pictures have the same size and are rectified. They outlive what follows.
  void look_at(const ImageView& left, const ImageView& right) {
    left_ = left;
    right_ = right;
  }

  /// Aligns `face`, starting with the best of `starts` (planes) and of those a few pixels nearer or
  /// farther; or why not.
  Expected<Alignment> align(const Features& face, const std::vector<DisparitySurface>& starts);
  /// Aligns one feature of the face alone, after `align`, starting from what came of that: its own
  /// disparities and slopes, and agreement with the noise of the whole face. False when too little
  /// of it can be compared.
  bool align_feature(const FaceArea& feature, Alignment& alignment);

 private:
  void cut(double disparity, int step);
  double choose_pixels(const FaceArea& area, int stride);
  DisparitySurface best(const std::vector<DisparitySurface>& starts) const;
  double dissimilarity(const DisparitySurface& surface) const;

  ImageView left_, right_;
  FaceFrame frame_{{{0, 0}, {1, 0}, {0, 1}}};
  GreyLevel in_left_, in_right_;
  ComparedPixels pixels_;
  Aligner aligner_;
};

}  // namespace armature::face_pose::surface
