// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/read_volume.hpp"

#include <fmt/format.h>

#include "armature/volume/nrrd.hpp"

namespace armature {

Expected<Volume> read_volume(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return refuse(fmt::format("there is no '{}'", path.string()));
  }
  return read_nrrd(path);
}

}  // namespace armature
