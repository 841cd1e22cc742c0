// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "armature/values/expected.hpp"
#include "armature/volume/volume.hpp"

namespace armature ARMATURE_EXPORT {

/// Reads a volume from an NRRD file, or from a folder that holds one DICOM series. Refuses by name
/// what is there not, is neither, or is no sound volume: see `read_nrrd` and `read_dicom_series`.
Expected<Volume> read_volume(const std::filesystem::path& path);

}  // namespace armature
