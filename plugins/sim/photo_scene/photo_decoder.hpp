// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "armature/scene/photo.hpp"

namespace armature::sim::photo_scene {

/// Decodes the bytes of a PNG or JPEG into a mono8 image, turned as the file says; false: they are
/// none, and `why` is the reason. A function of a
/// library of its own, which is loaded when a photo is read: OpenCV's codecs bring a hundred others
/// with them, for which every scene would wait, and most scenes draw their face.
using DecodePhoto = bool(const std::vector<std::uint8_t>& file, scene::GrayImage& image,
                         std::string& why);

inline constexpr const char* kPhotoDecoder = "libarmature_photo_decoder.so";
inline constexpr const char* kDecodePhoto = "armature_decode_photo";

}  // namespace armature::sim::photo_scene
