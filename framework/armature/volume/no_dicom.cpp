// SPDX-License-Identifier: Apache-2.0
// In place of the reader of DICOM files, where there is no DCMTK.
#include <fmt/format.h>

#include "armature/volume/dicom_series.hpp"

namespace armature {

Expected<Volume> read_dicom_series(const std::filesystem::path& folder) {
  return refuse(fmt::format("'{}' is a folder, and this build reads no DICOM (ARMATURE_DICOM)",
                            folder.string()));
}

}  // namespace armature
