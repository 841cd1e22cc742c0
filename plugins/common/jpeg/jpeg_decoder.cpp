// SPDX-License-Identifier: Apache-2.0
#include "jpeg_decoder.hpp"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <stdexcept>
#include <string>

namespace armature::jpeg {

bool is_jpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

void JpegDecoder::Close::operator()(void* decompressor) const { tjDestroy(decompressor); }

JpegDecoder::JpegDecoder() : decompressor_{tjInitDecompress()} {
  if (!decompressor_) throw std::runtime_error(tjGetErrorStr2(nullptr));
}

Expected<Size> JpegDecoder::size_of(std::span<const std::uint8_t> jpeg) {
  Size size;
  int sampling = 0, colours = 0;
  if (tjDecompressHeader3(decompressor_.get(), jpeg.data(), jpeg.size(), &size.width, &size.height,
                          &sampling, &colours) != 0) {
    return refuse_with_reason();
  }
  if (size.width <= 0 || size.height <= 0) {
    return refuse("a JPEG cannot be unpacked: it has no picture");
  }
  return size;
}

Expected<void> JpegDecoder::decode_gray(std::span<const std::uint8_t> jpeg, int width, int height,
                                        std::vector<std::uint8_t>& pixels) {
  const auto size = size_of(jpeg);
  if (!size) return tl::unexpected{size.error()};
  if (size->width != width || size->height != height) {
    return refuse(fmt::format("a JPEG has {} x {} pixels instead of {} x {}", size->width,
                              size->height, width, height));
  }
  pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  if (tjDecompress2(decompressor_.get(), jpeg.data(), jpeg.size(), pixels.data(), width, 0, height,
                    TJPF_GRAY, 0) != 0) {
    return refuse_with_reason();
  }
  return {};
}

tl::unexpected<Reason> JpegDecoder::refuse_with_reason() const {
  return refuse(std::string{"a JPEG cannot be unpacked: "} + tjGetErrorStr2(decompressor_.get()));
}

}  // namespace armature::jpeg
