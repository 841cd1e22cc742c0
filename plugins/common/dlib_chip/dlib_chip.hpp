// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dlib/image_transforms.h>

#include <algorithm>
#include <cmath>

#include "armature/kinds/image_view.hpp"

namespace armature::dlib_chip {

using Image = dlib::array2d<unsigned char>;

/// A part of an image, resampled, and the way back.
struct Chip {
  Image image;
  dlib::point_transform_affine image_T_chip, chip_T_image;
};

inline Image copied(const ImageView& view) {
  Image image(view.height, view.width);
  for (int v = 0; v < view.height; ++v) {
    const std::uint8_t* row = view.data + static_cast<std::size_t>(v) * view.stride;
    std::copy(row, row + view.width, &image[v][0]);
  }
  return image;
}

inline dlib::drectangle rectangle(const PixelBox& box) {
  return {box.left, box.top, box.right(), box.bottom()};
}

/// `box` resampled to `scale` chip pixels per image pixel; outside of the image all is black.
inline Chip cut(const Image& image, const PixelBox& box, double scale) {
  const auto size = [&](double length) {
    return static_cast<unsigned long>(std::lround(length * scale)) + 1;
  };
  const dlib::chip_details details{rectangle(box),
                                   dlib::chip_dims{size(box.height), size(box.width)}};
  Chip chip;
  dlib::extract_image_chip(image, details, chip.image, dlib::interpolate_bilinear());
  chip.chip_T_image = dlib::get_mapping_to_chip(details);
  chip.image_T_chip = dlib::inv(chip.chip_T_image);
  return chip;
}

}  // namespace armature::dlib_chip
