// SPDX-License-Identifier: Apache-2.0
#include "photo_decoder.hpp"

#include <opencv2/imgcodecs.hpp>

#include "jpeg_decoder.hpp"
#include "picture_size.hpp"

using namespace armature;

namespace {

/// Whether all of a JPEG is there: OpenCV fills the rows that it lacks with grey, and says nothing.
Expected<void> check_jpeg(const std::vector<std::uint8_t>& file) {
  jpeg::JpegDecoder decoder;
  const auto size = decoder.size_of(file);
  if (!size) return tl::unexpected{size.error()};
  if (auto taken = pictures::check_size({size->width, size->height}); !taken) return taken;
  std::vector<std::uint8_t> pixels;
  return decoder.decode_gray(file, size->width, size->height, pixels);
}

/// A few kilobytes would take gigabytes before OpenCV knows their size.
Expected<void> check(const std::vector<std::uint8_t>& file) {
  if (jpeg::is_jpeg(file)) return check_jpeg(file);
  return pictures::told_size(file).and_then(pictures::check_size);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) bool armature_decode_photo(
    const std::vector<std::uint8_t>& file, scene::GrayImage& image, std::string& why) {
  if (const auto taken = check(file); !taken) {
    why = taken.error().text;
    return false;
  }
  cv::Mat decoded;
  try {
    decoded = cv::imdecode(file, cv::IMREAD_GRAYSCALE);
  } catch (const cv::Exception&) {
    decoded.release();
  }
  if (decoded.empty()) {
    why = "a part of it is missing or wrong";
    return false;
  }
  image.width = decoded.cols;
  image.height = decoded.rows;
  image.pixels.assign(decoded.begin<std::uint8_t>(), decoded.end<std::uint8_t>());
  return true;
}
