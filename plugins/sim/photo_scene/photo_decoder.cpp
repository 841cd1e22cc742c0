// SPDX-License-Identifier: Apache-2.0
#include "photo_decoder.hpp"

#include <opencv2/imgcodecs.hpp>

using namespace armature;

extern "C" __attribute__((visibility("default"))) bool armature_decode_photo(
    const std::vector<std::uint8_t>& file, scene::GrayImage& image) {
  const cv::Mat decoded = cv::imdecode(file, cv::IMREAD_GRAYSCALE);
  if (decoded.empty()) return false;
  image.width = decoded.cols;
  image.height = decoded.rows;
  image.pixels.assign(decoded.begin<std::uint8_t>(), decoded.end<std::uint8_t>());
  return true;
}
