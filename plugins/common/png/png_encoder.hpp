// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace armature::png {

/// Pixels of somebody else: `height` rows, each `stride` bytes after the one before, of `width`
/// pixels of `channels` bytes: 1 is grey, 3 are blue, green and red.
struct Pixels {
  int width = 0, height = 0, channels = 1;
  const std::uint8_t* data = nullptr;
  std::size_t stride = 0;
};

/// The bytes of a PNG file, as libpng writes them. Throws std::invalid_argument for a picture
/// without pixels or of other channels, std::runtime_error with libpng's words. Not real-time safe.
std::string encoded(const Pixels& pixels);

}  // namespace armature::png
