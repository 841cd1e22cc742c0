// SPDX-License-Identifier: Apache-2.0
#include "armature/scene/gaussian_blur.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace armature::scene {
namespace {

constexpr double kReach = 3.0;  // sigmas

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

PixelRegion PixelRegion::grown(int margin, int width, int height) const {
  return {std::max(left - margin, 0), std::max(top - margin, 0), std::min(right + margin, width),
          std::min(bottom + margin, height)};
}

GaussianBlur::GaussianBlur(double sigma_px) {
  const int reach = sigma_px > 0 ? static_cast<int>(std::ceil(kReach * sigma_px)) : 0;
  std::vector<double> exact{1.0};
  double sum = 1;
  for (int i = 1; i <= reach; ++i) {
    exact.push_back(std::exp(-0.5 * i * i / (sigma_px * sigma_px)));
    sum += 2 * exact.back();
  }
  for (const double weight : exact) weights_.push_back(static_cast<float>(weight / sum));
}

void GaussianBlur::apply(std::span<float> picture, int width, const PixelRegion& region) {
  if (reach() == 0 || region.empty()) return;
  const int height = static_cast<int>(picture.size()) / width;
  const PixelRegion needed{region.left, std::max(region.top - reach(), 0), region.right,
                           std::min(region.bottom + reach(), height)};
  along_rows(picture, width, needed);
  const int columns = region.right - region.left;
  const auto blurred_row = [&](int v) {
    v = std::clamp(v, needed.top, needed.bottom - 1);
    return &rows_[index(v - needed.top) * index(columns)];
  };
  for (int v = region.top; v < region.bottom; ++v) {
    float* out = &picture[index(v) * index(width) + index(region.left)];
    const float* middle = blurred_row(v);
    for (int u = 0; u < columns; ++u) out[u] = weights_[0] * middle[u];
    for (int i = 1; i <= reach(); ++i) {
      const float* above = blurred_row(v - i);
      const float* below = blurred_row(v + i);
      const float weight = weights_[index(i)];
      for (int u = 0; u < columns; ++u) out[u] += weight * (above[u] + below[u]);
    }
  }
}

void GaussianBlur::along_rows(std::span<const float> picture, int width, const PixelRegion& rows) {
  const int columns = rows.right - rows.left;
  rows_.resize(std::max(rows_.size(), index(columns) * index(rows.bottom - rows.top)));
  row_.resize(std::max(row_.size(), index(columns + 2 * reach())));
  for (int v = rows.top; v < rows.bottom; ++v) {
    const float* from = &picture[index(v) * index(width)];
    for (int u = -reach(); u < columns + reach(); ++u) {
      row_[index(u + reach())] = from[std::clamp(rows.left + u, 0, width - 1)];
    }
    const float* middle = &row_[index(reach())];
    float* out = &rows_[index(v - rows.top) * index(columns)];
    for (int u = 0; u < columns; ++u) out[u] = weights_[0] * middle[u];
    for (int i = 1; i <= reach(); ++i) {
      const float weight = weights_[index(i)];
      for (int u = 0; u < columns; ++u) out[u] += weight * (middle[u - i] + middle[u + i]);
    }
  }
}

}  // namespace armature::scene
