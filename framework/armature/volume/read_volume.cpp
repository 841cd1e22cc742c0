// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/read_volume.hpp"

#include <fmt/format.h>

#include "armature/volume/dicom_series.hpp"
#include "armature/volume/nrrd.hpp"

namespace armature {

Expected<Volume> read_volume(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return refuse(fmt::format("there is no '{}'", path.string()));
  }
  return std::filesystem::is_directory(path, error) ? read_dicom_series(path) : read_nrrd(path);
}

}  // namespace armature
