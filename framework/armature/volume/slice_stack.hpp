// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "armature/values/expected.hpp"
#include "armature/volume/dicom_slice.hpp"
#include "armature/volume/volume.hpp"

namespace armature {

/// Slices in any order as one volume, stacked along their normal. Refuses those of several series,
/// and those that are not alike or not a whole, straight stack at equal distances.
Expected<Volume> stacked(std::vector<DicomSlice> slices);

}  // namespace armature
