// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/values/expected.hpp"

namespace armature::pictures {

/// A mono8 picture without padding.
struct GrayPicture {
  int width = 0, height = 0;  // [px]
  std::vector<std::uint8_t> pixels;
};

/// The picture of a file (PNG, JPEG, PGM, BMP, TIFF), colours turned grey, as the sensor had it:
/// what a file says of its orientation is not followed. Refuses a file of which a part is missing
/// or damaged. The reason names the file.
Expected<GrayPicture> read_picture(const std::filesystem::path& file);
/// The same of a message: mono8, rgb8, bgr8, rgba8, bgra8.
Expected<GrayPicture> gray_picture_of(const msg::Image& image);
/// The same of the bytes of a file.
Expected<GrayPicture> decode_picture(std::span<const std::uint8_t> bytes);

}  // namespace armature::pictures
