// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "armature/values/expected.hpp"

namespace armature::pictures {

/// Columns and rows [px].
struct PictureSize {
  std::int64_t width = 0, height = 0;
};

/// What the beginning of a file says of its picture: a PNG, BMP, TIFF, PGM or PPM. Refuses another
/// file, and one whose beginning does not say it.
Expected<PictureSize> told_size(std::span<const std::uint8_t> bytes);

/// Refuses a picture that would take too much memory: more than 16384 pixels a side, or 100 million
/// in all. A file of a few kilobytes may unpack to gigabytes.
Expected<void> check_size(const PictureSize& size);

/// A longer file is no picture of a size that is taken.
inline constexpr std::size_t kMaxPictureBytes = 420'000'000;

}  // namespace armature::pictures
