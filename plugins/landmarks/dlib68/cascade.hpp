// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlib/image_processing.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <vector>

#include "dlib_chip.hpp"

namespace armature::landmarks::dlib68 {

/// A cascade of regression trees (Kazemi and Sullivan, "One Millisecond Face Alignment with an
/// Ensemble of Regression Trees", CVPR 2014) out of a model file of dlib, and evaluated as dlib
/// does it, landmark for landmark. What a face takes is waiting for leaves to come from memory:
/// here they lie side by side, and each is asked for before it is needed.
class Cascade {
 public:
  /// Reads dlib's file of a shape predictor. Throws dlib::serialization_error for anything else.
  static Cascade read(std::istream& in);

  std::size_t landmarks() const { return landmarks_; }
  /// Where the landmarks of the face in `box` are in the image [px], not rounded. Allocates.
  std::vector<Eigen::Vector2d> find(const dlib_chip::Image& image,
                                    const dlib::rectangle& box) const;

 private:
  using Shape = dlib::matrix<float, 0, 1>;  // x and y of the landmarks in the box: 0 to 1

  /// A node of a tree: whether one pixel is brighter than another by more than a threshold.
  struct Split {
    std::uint32_t one, other;
    float threshold;
  };
  /// Trees of one depth, whose answers are added; and the pixels that they look at, each by a
  /// landmark and the way from it to the pixel.
  struct Level {
    std::vector<unsigned long> anchor;
    std::vector<dlib::vector<float, 2>> delta;
    std::size_t trees = 0, splits_of_tree = 0;
    std::vector<Split> splits;  // tree by tree
    std::vector<float> leaves;  // tree by tree, leaf by leaf: what is added to the shape
  };

  static Level read_level(std::istream& in, std::size_t leaf_size);
  void check(const Level& level) const;
  void add_answers(const Level& level, const std::vector<float>& pixels,
                   std::vector<const float*>& answers, Shape& shape) const;

  std::size_t landmarks_ = 0;
  Shape initial_;
  std::vector<Level> levels_;
};

}  // namespace armature::landmarks::dlib68
