// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/volume_messages.hpp"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "armature/volume/read_volume.hpp"

namespace armature {
namespace {

/// Lengths in nanometres, directions in parts of 1e9, so that what a text file rounds is the same.
std::vector<std::int64_t> rounded(const VolumeGeometry& geometry) {
  std::vector<std::int64_t> numbers{geometry.size.begin(), geometry.size.end()};
  const auto add = [&](const auto& values) {
    for (const double value : values.reshaped()) numbers.push_back(std::llround(1e9 * value));
  };
  add(geometry.spacing);
  add(geometry.direction);
  add(geometry.origin);
  return numbers;
}

}  // namespace

std::string sha256_of(const Volume& volume) {
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context{EVP_MD_CTX_new(),
                                                                   EVP_MD_CTX_free};
  const std::vector<std::int64_t> geometry = rounded(volume.geometry);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr);
  EVP_DigestUpdate(context.get(), geometry.data(), geometry.size() * sizeof(std::int64_t));
  EVP_DigestUpdate(context.get(), volume.voxels.data(),
                   volume.voxels.size() * sizeof(std::int16_t));
  EVP_DigestFinal_ex(context.get(), digest.data(), &size);
  std::string text;
  for (unsigned int i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

Expected<Volume> volume_of(const msg::VolumeFile& file) {
  auto volume = read_volume(file.path_());
  if (volume && sha256_of(*volume) != file.sha256_()) {
    return refuse(
        fmt::format("'{}' holds another volume than the one that was announced", file.path_()));
  }
  return volume;
}

}  // namespace armature
