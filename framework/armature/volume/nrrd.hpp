// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "armature/values/expected.hpp"
#include "armature/volume/volume.hpp"

namespace armature ARMATURE_EXPORT {

/// Reads a volume from an NRRD file (Nearly Raw Raster Data,
/// teem.sourceforge.net/nrrd/format.html): three axes with `space directions` in millimetres, in
/// LPS or RAS, one number a voxel, of 8 to 64 bits, `raw` or `gzip`, in the file itself. Numbers
/// are Hounsfield units and are rounded to whole ones. Refuses with a reason that names the file:
/// another format, axes that are not at right angles, fewer or more voxels than it says, NaN,
/// numbers beyond 16 bits, numbers of several bytes whose order it does not say.
Expected<Volume> read_nrrd(const std::filesystem::path& file);

/// Writes `volume` as NRRD 4, raw, 16 bits, LPS. A reason names the file that cannot be written.
Expected<void> write_nrrd(const Volume& volume, const std::filesystem::path& file);

}  // namespace armature
