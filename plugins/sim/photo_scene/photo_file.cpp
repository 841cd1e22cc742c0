// SPDX-License-Identifier: Apache-2.0
#include "photo_file.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <vector>

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

}  // namespace

Expected<scene::Photo> read_photo(const std::string& file, const Eigen::Vector2d& left_eye,
                                  const Eigen::Vector2d& right_eye, const Eigen::Vector2d& mouth,
                                  double eye_distance_m) {
  std::ifstream stream{file, std::ios::binary};
  if (!stream) return refuse("cannot open the photo " + file);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>{stream}, {}};
  cv::Mat image;
  if (!bytes.empty()) {
    image = cv::imdecode(without_colour_profile(bytes), cv::IMREAD_GRAYSCALE);
  }
  if (image.empty()) return refuse(file + " is not an image that can be read");

  scene::Photo photo{.image = {.width = image.cols, .height = image.rows, .pixels = {}},
                     .left_eye = left_eye,
                     .right_eye = right_eye,
                     .mouth = mouth,
                     .m_per_px = eye_distance_m / (right_eye - left_eye).norm()};
  photo.image.pixels.assign(image.begin<std::uint8_t>(), image.end<std::uint8_t>());
  return photo;
}

}  // namespace armature::sim::photo_scene
