// SPDX-License-Identifier: Apache-2.0
#include "photo_decoder.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "jpeg_decoder.hpp"

using namespace armature;

namespace {

constexpr int kMaxSide = 16384;  // [px] a header of a few bytes would take gigabytes

/// Whether all of a JPEG is there: OpenCV fills the rows that it lacks with grey, and says nothing.
Expected<void> check_whole(const std::vector<std::uint8_t>& file) {
  jpeg::JpegDecoder decoder;
  const auto size = decoder.size_of(file);
  if (!size) return tl::unexpected{size.error()};
  if (std::max(size->width, size->height) > kMaxSide) return refuse("it has too many pixels");
  std::vector<std::uint8_t> pixels;
  return decoder.decode_gray(file, size->width, size->height, pixels);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) bool armature_decode_photo(
    const std::vector<std::uint8_t>& file, scene::GrayImage& image, std::string& why) {
  if (jpeg::is_jpeg(file)) {
    if (const auto whole = check_whole(file); !whole) {
      why = whole.error().text;
      return false;
    }
  }
  cv::Mat decoded;
  try {
    decoded = cv::imdecode(file, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    why = "it has too many pixels, or a part of it is missing";
    return false;
  }
  if (decoded.empty()) {
    why = "it is neither a PNG nor a JPEG, or a part of it is missing";
    return false;
  }
  image.width = decoded.cols;
  image.height = decoded.rows;
  image.pixels.assign(decoded.begin<std::uint8_t>(), decoded.end<std::uint8_t>());
  return true;
}
