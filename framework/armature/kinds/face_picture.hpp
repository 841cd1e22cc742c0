// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "armature/kinds/image_view.hpp"

namespace armature ARMATURE_EXPORT {

/// The pixels of an image for tests, rows one behind the other.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;

  ImageView view() const {
    return {.data = pixels.data(),
            .width = width,
            .height = height,
            .stride = static_cast<std::size_t>(width)};
  }

  static Picture of_one_grey(std::uint8_t grey, int width = 320, int height = 240) {
    return {width, height,
            std::vector<std::uint8_t>(static_cast<std::size_t>(width * height), grey)};
  }
  static Picture of_noise(std::uint64_t seed) {
    Picture picture = of_one_grey(0);
    std::mt19937_64 random{seed};
    for (auto& pixel : picture.pixels) pixel = static_cast<std::uint8_t>(random());
    return picture;
  }
  /// The same picture in rows that are longer by `more` pixels, which are white.
  Picture with_longer_rows(int more) const {
    Picture wide{width + more, height, {}};
    for (int v = 0; v < height; ++v) {
      const auto row = pixels.begin() + std::ptrdiff_t{v} * width;
      wide.pixels.insert(wide.pixels.end(), row, row + width);
      wide.pixels.insert(wide.pixels.end(), static_cast<std::size_t>(more), 255);
    }
    return wide;
  }
};

}  // namespace armature
