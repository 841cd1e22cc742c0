// SPDX-License-Identifier: Apache-2.0
#include "crop.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace armature::landmarks::face_mesh {
namespace {

/// A grey value, 0 to 255, between the pixels of an image, whose edge goes on outside of it.
float value_at(const ImageView& image, float u, float v) {
  u = std::clamp(u, 0.0f, static_cast<float>(image.width - 1));
  v = std::clamp(v, 0.0f, static_cast<float>(image.height - 1));
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  const int right = std::min(i + 1, image.width - 1), below = std::min(j + 1, image.height - 1);
  const float a = u - static_cast<float>(i), b = v - static_cast<float>(j);
  const std::uint8_t* row = image.data + static_cast<std::size_t>(j) * image.stride;
  const std::uint8_t* next = image.data + static_cast<std::size_t>(below) * image.stride;
  const float top = static_cast<float>(row[i]) + a * static_cast<float>(row[right] - row[i]);
  const float bottom = static_cast<float>(next[i]) + a * static_cast<float>(next[right] - next[i]);
  return top + b * (bottom - top);
}

}  // namespace

void cut(const ImageView& image, const Crop& crop, int pixels, std::span<float> grey) {
  constexpr int kMostSamples = 8;  // along each side of a pixel
  const int samples = std::clamp(static_cast<int>(std::ceil(crop.side / pixels)), 1, kMostSamples);
  const int fine = samples * pixels;
  const Eigen::Vector2f first = crop.in_image({0, 0}, fine).cast<float>();
  const auto step = static_cast<float>(crop.side / fine);
  const float share = 1 / (255.0f * static_cast<float>(samples * samples));
  std::ranges::fill(grey, 0.0f);
  for (int row = 0; row < fine; ++row) {
    const float v = first.y() + step * static_cast<float>(row);
    float* to = grey.data() + std::ptrdiff_t{row / samples} * pixels;
    for (int column = 0; column < fine; ++column) {
      const float u = first.x() + step * static_cast<float>(column);
      to[column / samples] += share * value_at(image, u, v);
    }
  }
}

}  // namespace armature::landmarks::face_mesh
