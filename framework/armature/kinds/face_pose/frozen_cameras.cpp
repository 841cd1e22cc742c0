// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/face_pose/frozen_cameras.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <numeric>

namespace armature {
namespace {

constexpr std::size_t kThinning = 8;  // of eight columns and rows one is compared
constexpr double kChanged = 0.125;    // share of pixels
constexpr int kNoisyPairs = 3;

/// Counts by part of the picture: four along its rows, four along its columns.
struct Parts {
  static constexpr std::size_t kAlong = 4;
  std::array<int, kAlong * kAlong> pixels{}, changed{};

  /// Rounding hides a noise of half a grey value in half of the pixels.
  bool show_noise() const {
    constexpr double kNoisy = 1.0 / 3;
    constexpr int kMost = 12;
    int noisy = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) noisy += changed[i] > kNoisy * pixels[i];
    return noisy >= kMost;
  }
};

}  // namespace

FrozenCameras::Change FrozenCameras::Camera::change(const ImageView& picture) {
  const bool is_new = picture.width != width || picture.height != height;
  width = picture.width;
  height = picture.height;
  const std::size_t columns = (static_cast<std::size_t>(width) + kThinning - 1) / kThinning;
  const std::size_t rows = (static_cast<std::size_t>(height) + kThinning - 1) / kThinning;
  thinned.resize(columns * rows);
  std::uint8_t* before = thinned.data();
  Parts parts;
  for (std::size_t j = 0; j < rows; ++j) {
    const std::uint8_t* row = picture.data + j * kThinning * picture.stride;
    for (std::size_t i = 0; i < columns; ++i, ++before) {
      const std::size_t part =
          j * Parts::kAlong / rows * Parts::kAlong + i * Parts::kAlong / columns;
      ++parts.pixels[part];
      parts.changed[part] += row[i * kThinning] != *before;
      *before = row[i * kThinning];
    }
  }
  if (is_new) return {};
  const int changed = std::accumulate(parts.changed.begin(), parts.changed.end(), 0);
  return {.share = static_cast<double>(changed) / static_cast<double>(thinned.size()),
          .is_noise = parts.show_noise()};
}

std::optional<FrozenCameras::Frozen> FrozenCameras::look_at(const ImageView& left,
                                                            const ImageView& right) {
  const std::array changes{cameras_[0].change(left), cameras_[1].change(right)};
  std::array<bool, 2> is_frozen{};
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    Camera& camera = cameras_[i];
    camera.repeats = changes[i].share == 0 ? camera.repeats + 1 : 0;
    is_frozen[i] = camera.repeats > 0 &&
                   (changes[1 - i].share >= kChanged || camera.noisy_pairs >= kNoisyPairs);
    // A repeated picture says nothing about noise.
    if (changes[i].share > 0) camera.noisy_pairs = changes[i].is_noise ? camera.noisy_pairs + 1 : 0;
  }
  const auto frozen = [&](std::size_t i, const std::string& who, const char* why,
                          const char* hint) {
    // Without a number, so that the reason stays the same as long as its cause.
    return Frozen{.why = fmt::format("{}: the same picture again, to the last bit, though {}; {}",
                                     who, why, hint),
                  .repeats = cameras_[i].repeats};
  };
  if (is_frozen[0] && is_frozen[1]) {
    return frozen(0, "both cameras are frozen", "there was noise before",
                  "look at what they share, and start their drivers again");
  }
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (!is_frozen[i]) continue;
    return frozen(
        i, i == 0 ? "the left camera is frozen" : "the right camera is frozen",
        changes[1 - i].share >= kChanged ? "the other camera's changes" : "there was noise before",
        "look at its cable, and start its driver again");
  }
  return std::nullopt;
}

}  // namespace armature
