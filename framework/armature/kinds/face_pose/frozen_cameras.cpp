// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/face_pose/frozen_cameras.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdlib>
#include <utility>

namespace armature {
namespace {

constexpr std::size_t kThinning = 8;  // of eight columns and rows one is compared
constexpr double kChanged = 0.125;    // share of pixels, by any amount
constexpr double kMoved = 0.005;      // share of pixels, by more than kMovedGrey
constexpr int kMovedGrey = 12;        // grey values: noise of two pictures reaches a half of it
constexpr int kNoisyPairs = 3;
constexpr const char* kOtherChanges = "the other camera's changes";
constexpr const char* kWasNoisy = "there was noise before";
constexpr const char* kOneWasNoisy =
    "there was noise before in one, and that one changed while the other did not";

std::size_t thinned(int pixels) {
  return (static_cast<std::size_t>(pixels) + kThinning - 1) / kThinning;
}

/// Rounding hides a noise of half a grey value in half of the pixels.
bool shows_noise(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& now,
                 std::size_t columns) {
  constexpr std::size_t kAlong = 4;  // parts of the picture along its rows, and along its columns
  constexpr double kNoisy = 1.0 / 3;
  constexpr int kMost = 12;
  std::array<int, kAlong * kAlong> pixels{}, changed{};
  const std::size_t rows = now.size() / columns;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const std::size_t part = i / columns * kAlong / rows * kAlong + i % columns * kAlong / columns;
    ++pixels[part];
    changed[part] += now[i] != before[i];
  }
  int noisy = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) noisy += changed[i] > kNoisy * pixels[i];
  return noisy >= kMost;
}

/// Whether a camera has seen what the other one must have seen, too. What lies farther than a face
/// in the left quarter of the left picture, or in the right one of the right picture, may be seen
/// by one camera only.
bool has_moved(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& now,
               std::size_t columns, bool is_left) {
  const std::size_t first = is_left ? columns / 4 : 0;
  const std::size_t last = is_left ? columns : columns - columns / 4;
  int pixels = 0, changed = 0, moved = 0;
  for (std::size_t row = 0; row < now.size(); row += columns) {
    for (std::size_t i = row + first; i < row + last; ++i) {
      const int difference = std::abs(now[i] - before[i]);
      ++pixels;
      changed += difference > 0;
      moved += difference > kMovedGrey;
    }
  }
  return changed >= kChanged * pixels || moved >= kMoved * pixels;
}

}  // namespace

void FrozenCameras::Camera::take(const ImageView& picture) {
  is_first = picture.width != width || picture.height != height;
  width = picture.width;
  height = picture.height;
  std::swap(now, before);
  const std::size_t columns = thinned(width), rows = thinned(height);
  now.resize(columns * rows);
  std::uint8_t* to = now.data();
  for (std::size_t j = 0; j < rows; ++j) {
    const std::uint8_t* row = picture.data + j * kThinning * picture.stride;
    for (std::size_t i = 0; i < columns; ++i) *to++ = row[i * kThinning];
  }
}

std::optional<FrozenCameras::Frozen> FrozenCameras::look_at(const ImageView& left,
                                                            const ImageView& right) {
  cameras_[0].take(left);
  cameras_[1].take(right);
  const std::array was_frozen{cameras_[0].proof != nullptr, cameras_[1].proof != nullptr};
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    Camera& camera = cameras_[i];
    const Camera& other = cameras_[1 - i];
    if (camera.has_changed()) {
      // A repeated picture says nothing about noise.
      const bool is_noise =
          !camera.is_first && shows_noise(camera.before, camera.now, thinned(camera.width));
      camera.noisy_pairs = is_noise ? camera.noisy_pairs + 1 : 0;
      camera.repeats = 0;
      camera.proof = nullptr;
    } else {
      ++camera.repeats;
    }
    // A camera that wakes up shows what has moved while it was frozen.
    if (camera.repeats == 0 || other.is_first || was_frozen[1 - i]) camera.other_then = other.now;
    if (camera.repeats == 0 || camera.proof) continue;
    if (has_moved(camera.other_then, other.now, thinned(other.width), i == 1)) {
      camera.proof = kOtherChanges;
    } else if (camera.noisy_pairs >= kNoisyPairs) {
      camera.proof = kWasNoisy;
    }
  }
  const auto frozen = [&](std::size_t i, const std::string& who, const char* why,
                          const char* hint) {
    // Without a number, so that the reason stays the same as long as its cause.
    return Frozen{.why = fmt::format("{}: the same picture again, to the last bit, though {}; {}",
                                     who, why, hint),
                  .repeats = cameras_[i].repeats};
  };
  if (cameras_[0].proof && cameras_[1].proof) {
    const bool alike = cameras_[0].proof == cameras_[1].proof;
    return frozen(0, "both cameras are frozen", alike ? cameras_[0].proof : kOneWasNoisy,
                  "look at what they share, and start their drivers again");
  }
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    if (!cameras_[i].proof) continue;
    return frozen(i, i == 0 ? "the left camera is frozen" : "the right camera is frozen",
                  cameras_[i].proof, "look at its cable, and start its driver again");
  }
  return std::nullopt;
}

}  // namespace armature
