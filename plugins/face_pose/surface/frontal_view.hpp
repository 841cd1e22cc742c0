// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "alignment.hpp"
#include "armature/kinds/image_view.hpp"
#include "face_frame.hpp"

namespace armature::face_pose::surface {

/// A picture of the face as a camera would take it that stands before it, upright and square to the
/// plane of its eyes and mouth: both pictures are warped into it and averaged. There landmark
/// finders err least, and by the same in every pose. A plane that touches a round face between the
/// eyes would show the mouth a third too far down, where no finder looks for it.
class FrontalView {
 public:
  /// The face takes as many pixels as finders want it to, however far away it is.
  void render(const ImageView& left, const ImageView& right, const Alignment& alignment,
              const Features& features, const StereoCamera& camera);

  /// The view, stretched if it is dark.
  ImageView image();
  /// Boxes in which to seek the face, in two squares: of each the upper left corner, the lower
  /// right one, then the other two. The second square is lower, where detectors put their boxes:
  /// there finders see a mouth in the dark; from the first one they see eyes behind glasses.
  std::array<std::array<PixelBox, 4>, 2> face_boxes() const;
  double eye_distance() const;  // [px]
  /// The pixel of the left picture that a point [px] of the view shows.
  Eigen::Vector2d in_left(const Eigen::Vector2d& in_view) const {
    return (left_H_view_ * in_view.homogeneous()).hnormalized();
  }

 private:
  static constexpr int kSize = 420;  // [px]

  Eigen::Matrix3d left_H_view_ = Eigen::Matrix3d::Identity();
  std::vector<std::uint8_t> pixels_, stretched_;
};

}  // namespace armature::face_pose::surface
