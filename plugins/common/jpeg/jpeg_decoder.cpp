// SPDX-License-Identifier: Apache-2.0
#include "jpeg_decoder.hpp"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <stdexcept>
#include <string>

namespace armature::jpeg {

void JpegDecoder::Close::operator()(void* decompressor) const { tjDestroy(decompressor); }

JpegDecoder::JpegDecoder() : decompressor_{tjInitDecompress()} {
  if (!decompressor_) throw std::runtime_error(tjGetErrorStr2(nullptr));
}

Expected<void> JpegDecoder::decode_gray(std::span<const std::uint8_t> jpeg, int width, int height,
                                        std::vector<std::uint8_t>& pixels) {
  const auto because = [&] {
    return refuse(std::string{"a JPEG cannot be unpacked: "} + tjGetErrorStr2(decompressor_.get()));
  };
  int of_width = 0, of_height = 0, sampling = 0, colours = 0;
  if (tjDecompressHeader3(decompressor_.get(), jpeg.data(), jpeg.size(), &of_width, &of_height,
                          &sampling, &colours) != 0) {
    return because();
  }
  if (of_width <= 0 || of_height <= 0)
    return refuse("a JPEG cannot be unpacked: it has no picture");
  if (of_width != width || of_height != height) {
    return refuse(fmt::format("a JPEG has {} x {} pixels instead of {} x {}", of_width, of_height,
                              width, height));
  }
  pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  if (tjDecompress2(decompressor_.get(), jpeg.data(), jpeg.size(), pixels.data(), width, 0, height,
                    TJPF_GRAY, 0) != 0) {
    return because();
  }
  return {};
}

}  // namespace armature::jpeg
