// SPDX-License-Identifier: Apache-2.0
#include "luma.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace armature::camera::v4l2 {

Expected<void> luma_of(Layout layout, std::span<const std::uint8_t> bytes, int width, int height,
                       std::size_t stride, jpeg::JpegDecoder& decoder,
                       std::vector<std::uint8_t>& pixels) {
  if (layout == Layout::mjpeg) return decoder.decode_gray(bytes, width, height, pixels);
  const std::size_t columns = static_cast<std::size_t>(width),
                    rows = static_cast<std::size_t>(height);
  const std::size_t apart = layout == Layout::yuyv || layout == Layout::uyvy ? 2 : 1;
  const std::size_t row_bytes = apart * columns;
  const std::size_t needed = stride * (rows - 1) + row_bytes;
  if (stride < row_bytes || bytes.size() < needed) {
    return refuse(fmt::format("a picture has {} bytes, {} a row; {} x {} pixels need {}",
                              bytes.size(), stride, width, height, needed));
  }
  pixels.resize(columns * rows);
  for (std::size_t v = 0; v < rows; ++v) {
    const std::uint8_t* from = bytes.data() + v * stride + (layout == Layout::uyvy ? 1 : 0);
    std::uint8_t* to = pixels.data() + v * columns;
    if (apart == 1) {
      std::copy_n(from, columns, to);
    } else {
      for (std::size_t u = 0; u < columns; ++u) to[u] = from[2 * u];
    }
  }
  return {};
}

}  // namespace armature::camera::v4l2
