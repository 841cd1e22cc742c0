// SPDX-License-Identifier: Apache-2.0
#include "gray_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "jpeg_decoder.hpp"

namespace armature::pictures {
namespace {

constexpr int kMaxSide = 16384;  // [px]

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

tl::unexpected<Reason> refuse_size(std::int64_t width, std::int64_t height) {
  return refuse(fmt::format("it has {} x {} pixels; a side may have {}", width, height, kMaxSide));
}

/// Width and height of a PNG, as its beginning tells them; nothing of another file.
std::optional<std::array<std::uint32_t, 2>> size_of_png(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kSignature{"\x89PNG\r\n\x1a\n"};
  constexpr std::size_t kWidthAt = 16, kEnd = 24;
  if (bytes.size() < kEnd || std::memcmp(bytes.data(), kSignature.data(), kSignature.size()) != 0) {
    return std::nullopt;
  }
  const auto number_at = [&](std::size_t at) {
    std::uint32_t number = 0;
    for (const std::uint8_t byte : bytes.subspan(at, sizeof number)) number = number << 8U | byte;
    return number;
  };
  return std::array{number_at(kWidthAt), number_at(kWidthAt + sizeof(std::uint32_t))};
}

/// OpenCV fills the rows that a JPEG lacks with grey, and says nothing.
Expected<GrayPicture> decode_jpeg(std::span<const std::uint8_t> bytes) {
  jpeg::JpegDecoder decoder;
  const auto size = decoder.size_of(bytes);
  if (!size) return tl::unexpected{size.error()};
  if (std::max(size->width, size->height) > kMaxSide) return refuse_size(size->width, size->height);
  GrayPicture picture{.width = size->width, .height = size->height};
  const auto decoded = decoder.decode_gray(bytes, size->width, size->height, picture.pixels);
  if (!decoded) return tl::unexpected{decoded.error()};
  return picture;
}

}  // namespace

Expected<GrayPicture> decode_picture(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return refuse("it is empty");
  if (jpeg::is_jpeg(bytes)) return decode_jpeg(bytes);
  // A megabyte of PNG would take gigabytes before its size is known.
  const auto size = size_of_png(bytes);
  if (size && std::ranges::max(*size) > kMaxSide) return refuse_size((*size)[0], (*size)[1]);
  cv::Mat gray;
  try {
    const cv::Mat file{1, static_cast<int>(bytes.size()), CV_8UC1,
                       const_cast<std::uint8_t*>(bytes.data())};
    gray = cv::imdecode(file,
                        cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return refuse(fmt::format(
        "it is not a picture that can be read, or has too many pixels; a side may have {}",
        kMaxSide));
  }
  if (gray.empty()) return refuse("it is not a picture that can be read");
  if (std::max(gray.cols, gray.rows) > kMaxSide) return refuse_size(gray.cols, gray.rows);
  if (gray.depth() != CV_8U) {
    return refuse(fmt::format("it has {} bits a pixel; 8 are read", 8 * gray.elemSize1()));
  }
  return picture_of(gray);
}

Expected<GrayPicture> read_picture(const std::filesystem::path& file) {
  std::ifstream stream{file, std::ios::binary};
  if (!stream) return refuse(file.string() + ": cannot be opened: " + std::strerror(errno));
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>{stream}, {}};
  auto picture = decode_picture(bytes);
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
