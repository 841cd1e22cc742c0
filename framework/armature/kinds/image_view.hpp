// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace armature ARMATURE_EXPORT {

/// A mono8 image that somebody else owns; `stride` bytes from row to row.
struct ImageView {
  const std::uint8_t* data = nullptr;
  int width = 0, height = 0;  // [px]
  std::size_t stride = 0;
};

/// A rectangle along the image's rows and columns [px].
struct PixelBox {
  double left = 0, top = 0, width = 0, height = 0;

  double right() const { return left + width; }
  double bottom() const { return top + height; }
  /// The box about the same centre, `factor` times as wide and as high.
  PixelBox scaled(double factor) const {
    return {left - 0.5 * (factor - 1) * width, top - 0.5 * (factor - 1) * height, factor * width,
            factor * height};
  }
};

/// nullopt, or why the view is no image: no pixels, or rows that overlap. The first line of every
/// plugin that takes one.
inline std::optional<std::string> invalid_input(const ImageView& view) {
  if (view.data == nullptr || view.width <= 0 || view.height <= 0) return "empty image";
  if (view.stride >= static_cast<std::size_t>(view.width)) return std::nullopt;
  return "an image of " + std::to_string(view.width) + " pixels in rows of " +
         std::to_string(view.stride);
}

}  // namespace armature
