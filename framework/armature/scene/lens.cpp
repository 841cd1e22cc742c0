// SPDX-License-Identifier: Apache-2.0
#include "armature/scene/lens.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "armature/scene/splitmix.hpp"

namespace armature::scene {
namespace {

constexpr std::size_t kNoiseLength = std::size_t{1} << 16;

}  // namespace

Lens::Lens(const ImagingSettings& settings, std::uint64_t seed)
    : blur_{settings.blur_px}, motion_px_{settings.motion_px}, seed_{seed} {
  std::mt19937_64 generator{seed};
  std::normal_distribution<float> normal{0.0f, static_cast<float>(settings.noise)};
  noise_.assign(kNoiseLength + kWidestImage, 0.0f);
  if (settings.noise > 0) {
    std::generate(noise_.begin(), noise_.end(), [&] { return normal(generator); });
  }
}

void Lens::blur(Canvas& canvas, const PixelRegion& region) {
  if (region.empty()) return;
  blur_.apply(canvas.pixels, canvas.width,
              region.grown(blur_.reach(), canvas.width, canvas.height));
  if (motion_px_.isZero(0)) return;
  const int moved = static_cast<int>(std::ceil(motion_px_.cwiseAbs().maxCoeff() / 2)) + 1;
  smear(canvas, region.grown(blur_.reach() + moved, canvas.width, canvas.height));
}

// The mean along the way, of places that are at most half a pixel apart.
void Lens::smear(Canvas& canvas, const PixelRegion& region) {
  const int places = 2 * static_cast<int>(std::ceil(motion_px_.norm())) + 1;
  const auto share = 1.0f / static_cast<float>(places);
  still_ = canvas.pixels;
  for (int v = region.top; v < region.bottom; ++v) {
    std::fill(canvas.row(v) + region.left, canvas.row(v) + region.right, 0.0f);
  }
  for (int place = 0; place < places; ++place) {
    const Eigen::Vector2d shift = (static_cast<double>(place) / (places - 1) - 0.5) * motion_px_;
    const int du = static_cast<int>(std::floor(shift.x())),
              dv = static_cast<int>(std::floor(shift.y()));
    const auto a = static_cast<float>(shift.x() - du), b = static_cast<float>(shift.y() - dv);
    const auto at = [&](int u, int v) {
      u = std::clamp(u, 0, canvas.width - 1);
      v = std::clamp(v, 0, canvas.height - 1);
      return still_[static_cast<std::size_t>(v) * static_cast<std::size_t>(canvas.width) +
                    static_cast<std::size_t>(u)];
    };
    for (int v = region.top; v < region.bottom; ++v) {
      float* row = canvas.row(v);
      for (int u = region.left; u < region.right; ++u) {
        const float top = (1 - a) * at(u + du, v + dv) + a * at(u + du + 1, v + dv);
        const float bottom = (1 - a) * at(u + du, v + dv + 1) + a * at(u + du + 1, v + dv + 1);
        row[u] += share * ((1 - b) * top + b * bottom);
      }
    }
  }
}

void Lens::expose(const Canvas& canvas, std::uint64_t picture, std::span<std::uint8_t> out) const {
  const auto width = static_cast<std::size_t>(canvas.width);
  for (std::size_t v = 0; v < static_cast<std::size_t>(canvas.height); ++v) {
    const float* row = &canvas.pixels[v * width];
    const float* noise = &noise_[splitmix(splitmix(seed_ + picture) + v) % kNoiseLength];
    std::uint8_t* to = &out[v * width];
    for (std::size_t u = 0; u < width; ++u) {
      const float value = row[u] + noise[u] + 0.5f;
      to[u] = static_cast<std::uint8_t>(static_cast<int>(std::min(std::max(value, 0.0f), 255.0f)));
    }
  }
}

}  // namespace armature::scene
