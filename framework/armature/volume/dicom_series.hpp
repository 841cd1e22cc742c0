// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "armature/values/expected.hpp"
#include "armature/volume/volume.hpp"

namespace armature ARMATURE_EXPORT {

/// Reads the one series of computed tomography that lies in a folder, a file for each slice (DICOM
/// PS3.3 C.8.2, not compressed); files that are no DICOM, and a DICOMDIR, are passed over. Refuses
/// with a reason that names the folder or the file: no or several series, another modality, a
/// tilted gantry, slices that are missing, unequally spaced, pushed aside, at the same place, or
/// not alike, a file that ends too early. Without ARMATURE_DICOM: refuses every folder.
Expected<Volume> read_dicom_series(const std::filesystem::path& folder);

}  // namespace armature
