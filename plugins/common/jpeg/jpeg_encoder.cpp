// SPDX-License-Identifier: Apache-2.0
#include "jpeg_encoder.hpp"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

namespace armature::jpeg {
namespace {

struct Encoding {
  std::string_view name;
  TJPF format;
};
constexpr std::array<Encoding, 5> kEncodings{{{"mono8", TJPF_GRAY},
                                              {"rgb8", TJPF_RGB},
                                              {"bgr8", TJPF_BGR},
                                              {"rgba8", TJPF_RGBA},
                                              {"bgra8", TJPF_BGRA}}};
constexpr std::uint32_t kMaxSide = 65'500;  // of JPEG

}  // namespace

void JpegEncoder::Close::operator()(void* compressor) const { tjDestroy(compressor); }

JpegEncoder::JpegEncoder(int quality) : compressor_{tjInitCompress()}, quality_{quality} {
  if (!compressor_) throw std::runtime_error(tjGetErrorStr2(nullptr));
}

Expected<void> JpegEncoder::encode(const msg::Image& image, std::vector<std::uint8_t>& jpeg) {
  const auto encoding = std::ranges::find(kEncodings, image.encoding_(), &Encoding::name);
  if (encoding == kEncodings.end()) {
    return refuse(fmt::format("a picture is '{}', which is none of mono8, rgb8, bgr8, rgba8, bgra8",
                              image.encoding_()));
  }
  const std::uint32_t width = image.width_(), height = image.height_(), step = image.step_();
  if (width == 0 || height == 0 || width > kMaxSide || height > kMaxSide) {
    return refuse(fmt::format("a picture of {} x {} pixels cannot be a JPEG", width, height));
  }
  const std::size_t row =
      std::size_t{width} * static_cast<std::size_t>(tjPixelSize[encoding->format]);
  if (step < row || image.data_().size() < std::size_t{step} * (height - 1) + row) {
    return refuse(fmt::format("a picture of {} x {} pixels has {} bytes, {} a row", width, height,
                              image.data_().size(), step));
  }
  const int sampling = encoding->format == TJPF_GRAY ? TJSAMP_GRAY : TJSAMP_420;
  const int w = static_cast<int>(width), h = static_cast<int>(height);
  jpeg.resize(tjBufSize(w, h, sampling));
  unsigned char* out = jpeg.data();
  unsigned long size = jpeg.size();
  if (tjCompress2(compressor_.get(), image.data_().data(), w, static_cast<int>(step), h,
                  encoding->format, &out, &size, sampling, quality_, TJFLAG_NOREALLOC) != 0) {
    return refuse(std::string{"a picture could not be compressed: "} +
                  tjGetErrorStr2(compressor_.get()));
  }
  jpeg.resize(size);
  return {};
}

}  // namespace armature::jpeg
