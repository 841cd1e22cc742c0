// SPDX-License-Identifier: Apache-2.0
#include "grey_level.hpp"

#include <cmath>

namespace armature::face_pose::surface {

void GreyLevel::cut(const ImageView& image, const PixelBox& part, int step) {
  step_ = step;
  per_step_ = 1.0f / static_cast<float>(step);
  const auto first = [](double at, int size) {
    return static_cast<int>(std::clamp(std::floor(at), 0.0, static_cast<double>(size)));
  };
  const int left = first(part.left, image.width), top = first(part.top, image.height);
  width_ = (first(part.right() + 1, image.width) - left) / step;
  height_ = (first(part.bottom() + 1, image.height) - top) / step;
  const float half = 0.5f * static_cast<float>(step - 1);
  first_u_ = static_cast<float>(left) + half;
  first_v_ = static_cast<float>(top) + half;
  pixels_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  const float share = per_step_ * per_step_;
  float* to = pixels_.data();
  for (int j = 0; j < height_; ++j, to += width_) {
    for (int in_step = 0; in_step < step; ++in_step) {
      const std::uint8_t* row =
          image.data + static_cast<std::size_t>(top + j * step + in_step) * image.stride + left;
      for (int i = 0; i < width_; ++i) {
        int sum = 0;
        for (int k = 0; k < step; ++k) sum += *row++;
        to[i] += share * static_cast<float>(sum);
      }
    }
  }
  smooth();
}

void GreyLevel::smooth() {
  const auto width = static_cast<std::size_t>(width_), height = static_cast<std::size_t>(height_);
  if (width_ < 3 || height_ < 3) return;
  scratch_.resize(pixels_.size());
  for (std::size_t j = 0; j < height; ++j) {
    const float* from = &pixels_[j * width];
    float* to = &scratch_[j * width];
    to[0] = from[0];
    to[width - 1] = from[width - 1];
    for (std::size_t i = 1; i + 1 < width; ++i) {
      to[i] = 0.25f * (from[i - 1] + from[i + 1]) + 0.5f * from[i];
    }
  }
  std::copy_n(scratch_.begin(), width, pixels_.begin());
  std::copy_n(scratch_.end() - width_, width, pixels_.end() - width_);
  for (std::size_t j = 1; j + 1 < height; ++j) {
    const float *above = &scratch_[(j - 1) * width], *at = &scratch_[j * width],
                *below = &scratch_[(j + 1) * width];
    float* to = &pixels_[j * width];
    for (std::size_t i = 0; i < width; ++i) to[i] = 0.25f * (above[i] + below[i]) + 0.5f * at[i];
  }
}

GreyLevel::Sample GreyLevel::sample(float u, float v) const {
  const float x = column(u), y = row(v);
  const auto i = static_cast<int>(x), j = static_cast<int>(y);
  const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
  const float* up = pixel(i, j - 1);
  const float *at = up + width_, *down = at + width_, *last = down + width_;
  const auto along = [a](float left, float right) { return left + a * (right - left); };
  const float v0 = along(at[0], at[1]), v1 = along(down[0], down[1]);
  const float half = 0.5f * per_step_;
  const float u0 = along(at[1] - at[-1], at[2] - at[0]);
  const float u1 = along(down[1] - down[-1], down[2] - down[0]);
  const float w0 = v1 - along(up[0], up[1]), w1 = along(last[0], last[1]) - v0;
  return {.value = v0 + b * (v1 - v0),
          .by_u = half * (u0 + b * (u1 - u0)),
          .by_v = half * (w0 + b * (w1 - w0))};
}

}  // namespace armature::face_pose::surface
