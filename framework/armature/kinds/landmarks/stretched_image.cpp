// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/landmarks/stretched_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace armature {
namespace {

constexpr std::size_t kGreyValues = 256;

}  // namespace

ImageView stretched_if_dark(const ImageView& image, double below,
                            std::vector<std::uint8_t>& pixels) {
  std::array<long, kGreyValues> count{};
  for (int v = 0; v < image.height; ++v) {
    const std::uint8_t* row = image.data + static_cast<std::size_t>(v) * image.stride;
    std::for_each(row, row + image.width, [&](std::uint8_t value) { ++count[value]; });
  }
  const double all = static_cast<double>(image.width) * image.height;
  const auto percentile = [&](double share) {
    long left = static_cast<long>(share * all);
    std::size_t value = 0;
    while (value + 1 < kGreyValues && (left -= count[value]) >= 0) ++value;
    return static_cast<double>(value);
  };
  const double low = percentile(0.005), high = percentile(0.995);
  if (high >= below || high - low < 4) return image;
  std::array<std::uint8_t, kGreyValues> table{};
  for (std::size_t i = 0; i < kGreyValues; ++i) {
    const double value = 255 * (static_cast<double>(i) - low) / (high - low);
    table[i] = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
  }
  const auto width = static_cast<std::size_t>(image.width);
  pixels.resize(width * static_cast<std::size_t>(image.height));
  for (int v = 0; v < image.height; ++v) {
    const std::uint8_t* row = image.data + static_cast<std::size_t>(v) * image.stride;
    std::transform(row, row + image.width, pixels.begin() + std::ptrdiff_t{v} * image.width,
                   [&](std::uint8_t value) { return table[value]; });
  }
  return {.data = pixels.data(), .width = image.width, .height = image.height, .stride = width};
}

}  // namespace armature
