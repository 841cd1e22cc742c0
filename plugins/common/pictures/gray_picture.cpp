// SPDX-License-Identifier: Apache-2.0
#include "gray_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <string_view>

#include "armature/values/regular_file.hpp"
#include "jpeg_decoder.hpp"
#include "picture_size.hpp"

namespace armature::pictures {
namespace {

constexpr std::uint32_t kMaxSide = 16384;  // [px]

struct Encoding {
  std::string_view name;
  int channels;
  int to_gray;  // OpenCV's conversion; -1: none is needed
};
constexpr std::array<Encoding, 5> kEncodings{{{"mono8", 1, -1},
                                              {"rgb8", 3, cv::COLOR_RGB2GRAY},
                                              {"bgr8", 3, cv::COLOR_BGR2GRAY},
                                              {"rgba8", 4, cv::COLOR_RGBA2GRAY},
                                              {"bgra8", 4, cv::COLOR_BGRA2GRAY}}};

GrayPicture picture_of(const cv::Mat& gray) {
  GrayPicture picture{.width = gray.cols, .height = gray.rows};
  picture.pixels.reserve(gray.total());
  for (int v = 0; v < gray.rows; ++v) {
    const auto* row = gray.ptr<std::uint8_t>(v);
    picture.pixels.insert(picture.pixels.end(), row, row + gray.cols);
  }
  return picture;
}

/// OpenCV fills the rows that a JPEG lacks with grey, and says nothing.
Expected<GrayPicture> decode_jpeg(std::span<const std::uint8_t> bytes) {
  jpeg::JpegDecoder decoder;
  const auto size = decoder.size_of(bytes);
  if (!size) return tl::unexpected{size.error()};
  if (const auto taken = check_size({size->width, size->height}); !taken) {
    return tl::unexpected{taken.error()};
  }
  GrayPicture picture{.width = size->width, .height = size->height};
  const auto decoded = decoder.decode_gray(bytes, size->width, size->height, picture.pixels);
  if (!decoded) return tl::unexpected{decoded.error()};
  return picture;
}

}  // namespace

Expected<GrayPicture> decode_picture(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return refuse("it is empty");
  if (jpeg::is_jpeg(bytes)) return decode_jpeg(bytes);
  // A few kilobytes would take gigabytes before OpenCV knows their size.
  const auto size = told_size(bytes);
  if (!size) return tl::unexpected{size.error()};
  if (const auto taken = check_size(*size); !taken) return tl::unexpected{taken.error()};
  cv::Mat gray;
  try {
    const cv::Mat file{1, static_cast<int>(bytes.size()), CV_8UC1,
                       const_cast<std::uint8_t*>(bytes.data())};
    gray = cv::imdecode(file,
                        cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    gray.release();
  }
  if (gray.empty()) return refuse("it is not a picture that can be read");
  if (gray.depth() != CV_8U) {
    return refuse(fmt::format("it has {} bits a pixel; 8 are read", 8 * gray.elemSize1()));
  }
  return picture_of(gray);
}

Expected<GrayPicture> read_picture(const std::filesystem::path& file) {
  const auto bytes = bytes_of_regular(file, kMaxPictureBytes);
  if (!bytes) return refuse(file.string() + ": cannot be read: " + bytes.error().text);
  auto picture =
      decode_picture({reinterpret_cast<const std::uint8_t*>(bytes->data()), bytes->size()});
  if (!picture) return refuse(file.string() + ": " + picture.error().text);
  return picture;
}

Expected<GrayPicture> gray_picture_of(const msg::Image& image) {
  const auto encoding = std::ranges::find(kEncodings, image.encoding_(), &Encoding::name);
  if (encoding == kEncodings.end()) {
    return refuse(fmt::format("it is '{}', which is none of mono8, rgb8, bgr8, rgba8, bgra8",
                              image.encoding_()));
  }
  const std::uint32_t width = image.width_(), height = image.height_();
  const std::size_t row = std::size_t{width} * static_cast<std::size_t>(encoding->channels);
  if (width == 0 || height == 0 || width > kMaxSide || height > kMaxSide || image.step_() < row ||
      image.data_().size() < std::size_t{image.step_()} * (height - 1) + row) {
    return refuse(fmt::format("it has {} x {} pixels and {} bytes, {} a row", width, height,
                              image.data_().size(), image.step_()));
  }
  const cv::Mat pixels{static_cast<int>(height), static_cast<int>(width),
                       CV_8UC(encoding->channels), const_cast<std::uint8_t*>(image.data_().data()),
                       image.step_()};
  if (encoding->to_gray < 0) return picture_of(pixels);
  cv::Mat gray;
  cv::cvtColor(pixels, gray, encoding->to_gray);
  return picture_of(gray);
}

}  // namespace armature::pictures
