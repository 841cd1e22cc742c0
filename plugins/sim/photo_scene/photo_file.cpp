// SPDX-License-Identifier: Apache-2.0
#include "photo_file.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>
#include <system_error>
#include <vector>

#include "armature/values/regular_file.hpp"
#include "photo_decoder.hpp"
#include "picture_size.hpp"

namespace armature::sim::photo_scene {
namespace {

constexpr std::size_t kSignature = 8;    // bytes in front of a PNG's first chunk
constexpr std::size_t kChunkFrame = 12;  // length, type and checksum of a chunk

// libpng prints a warning for the old sRGB profile in astronaut.png; a profile is of no use here.
std::vector<std::uint8_t> without_colour_profile(const std::vector<std::uint8_t>& file) {
  static constexpr std::uint8_t kPng[kSignature] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  if (file.size() < kSignature || !std::equal(std::begin(kPng), std::end(kPng), file.begin())) {
    return file;
  }
  std::vector<std::uint8_t> kept(file.begin(), file.begin() + kSignature);
  for (std::size_t at = kSignature; at + kChunkFrame <= file.size();) {
    const std::size_t length = (std::size_t{file[at]} << 24) | (std::size_t{file[at + 1]} << 16) |
                               (std::size_t{file[at + 2]} << 8) | std::size_t{file[at + 3]};
    if (length > file.size() - at - kChunkFrame) break;
    const auto begin = file.begin() + static_cast<std::ptrdiff_t>(at);
    const auto end = begin + static_cast<std::ptrdiff_t>(length + kChunkFrame);
    if (std::memcmp(&file[at + 4], "iCCP", 4) != 0) kept.insert(kept.end(), begin, end);
    at += length + kChunkFrame;
  }
  return kept;
}

struct Close {
  void operator()(void* library) const { dlclose(library); }
};

/// The picture in the bytes of `file`.
Expected<scene::GrayImage> decoded(const std::vector<std::uint8_t>& bytes,
                                   const std::string& file) {
  const std::unique_ptr<void, Close> library{dlopen(kPhotoDecoder, RTLD_NOW | RTLD_LOCAL)};
  if (!library) return refuse("cannot decode the photo " + file + ": " + dlerror());
  const auto decode = reinterpret_cast<DecodePhoto*>(dlsym(library.get(), kDecodePhoto));
  if (!decode) return refuse("cannot decode the photo " + file + ": " + dlerror());
  scene::GrayImage image;
  std::string why;
  if (bytes.empty()) return refuse(file + " is not an image that can be read: it is empty");
  if (!decode(bytes, image, why)) {
    return refuse(file + " is not an image that can be read: " + why);
  }
  return image;
}

}  // namespace

Expected<scene::Photo> read_photo(const std::string& file, const Eigen::Vector2d& left_eye,
                                  const Eigen::Vector2d& right_eye, const Eigen::Vector2d& mouth,
                                  double eye_distance_m) {
  std::error_code unknown;
  if (std::filesystem::exists(file, unknown) && !std::filesystem::is_regular_file(file, unknown)) {
    return refuse(file + " is no file; a photo is a PNG or JPEG");
  }
  const auto bytes = bytes_of_regular(file, pictures::kMaxPictureBytes);
  if (!bytes) return refuse("cannot open the photo " + file + ": " + bytes.error().text);
  auto image = decoded(without_colour_profile({bytes->begin(), bytes->end()}), file);
  if (!image) return tl::unexpected{image.error()};
  return scene::Photo{.image = std::move(*image),
                      .left_eye = left_eye,
                      .right_eye = right_eye,
                      .mouth = mouth,
                      .m_per_px = eye_distance_m / (right_eye - left_eye).norm()};
}

}  // namespace armature::sim::photo_scene
