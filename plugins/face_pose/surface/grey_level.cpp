// SPDX-License-Identifier: Apache-2.0
#include "grey_level.hpp"

#include <Eigen/Core>
#include <cmath>

namespace armature::face_pose::surface {
namespace {

using Four = Eigen::Vector4f;

/// What four pixels in a row weigh at `a` pixels behind the second one.
Four weights(float a) {
  const float b = 1 - a;
  return Four{b * b * b, 4 - 3 * a * a * (2 - a), 4 - 3 * b * b * (2 - b), a * a * a} * (1.0f / 6);
}
/// Their derivatives by `a`.
Four derivatives(float a) {
  const float b = 1 - a;
  return Four{-b * b, -a * (4 - 3 * a), b * (4 - 3 * b), a * a} * 0.5f;
}

}  // namespace

// Noise of pixel values that were smoothed by a kernel h has an autocorrelation whose sum over all
// pixels is (sum h)^2 / sum h^2; h is (1 2 1) / 4 and (1 4 1) / 6 one after the other, along rows
// and along columns.
double GreyLevel::shared_noise(double stride) {
  constexpr double kSquares = (1 + 36 + 100 + 36 + 1) / (24.0 * 24.0);
  return std::max(1.0, 1 / (kSquares * kSquares * stride * stride));
}

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

float GreyLevel::value(float u, float v) const {
  const float x = column(u), y = row(v);
  const auto i = static_cast<int>(x), j = static_cast<int>(y);
  const Four down = weights(y - static_cast<float>(j));
  const float* at = pixel(i - 1, j - 1);
  Four column = Four::Zero();
  for (int k = 0; k < 4; ++k, at += width_) column += down[k] * Eigen::Map<const Four>{at};
  return weights(x - static_cast<float>(i)).dot(column);
}

GreyLevel::Sample GreyLevel::sample(float u, float v) const {
  const float x = column(u), y = row(v);
  const auto i = static_cast<int>(x), j = static_cast<int>(y);
  const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
  const Four down = weights(b), by_down = derivatives(b);
  const float* at = pixel(i - 1, j - 1);
  Four column = Four::Zero(), by_v = Four::Zero();
  for (int k = 0; k < 4; ++k, at += width_) {
    const Eigen::Map<const Four> row{at};
    column += down[k] * row;
    by_v += by_down[k] * row;
  }
  const Four along = weights(a);
  return {.value = along.dot(column),
          .by_u = per_step_ * derivatives(a).dot(column),
          .by_v = per_step_ * along.dot(by_v)};
}

}  // namespace armature::face_pose::surface
