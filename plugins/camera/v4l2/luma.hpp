// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "armature/values/expected.hpp"
#include "jpeg_decoder.hpp"

namespace armature::camera::v4l2 {

/// How a camera's bytes are laid out. Source: linux/videodev2.h and the kernel's documentation of
/// its pixel formats.
enum class Layout {
  grey,  // a byte a pixel
  nv12,  // all brightness, then all colours
  yuyv,  // brightness, colour, brightness, colour
  uyvy,  // the same with colour first
  mjpeg  // a JPEG
};

/// Writes the brightness of a picture into `pixels`, `width * height` bytes; rows of `bytes` are
/// `stride` bytes apart. Refuses fewer bytes than that, and a JPEG that cannot be unpacked whole.
Expected<void> luma_of(Layout layout, std::span<const std::uint8_t> bytes, int width, int height,
                       std::size_t stride, jpeg::JpegDecoder& decoder,
                       std::vector<std::uint8_t>& pixels);

}  // namespace armature::camera::v4l2
