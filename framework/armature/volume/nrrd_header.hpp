// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <istream>
#include <optional>
#include <string>

#include "armature/values/expected.hpp"
#include "armature/volume/volume.hpp"

namespace armature {

/// What an NRRD file says of its voxels.
struct NrrdHeader {
  VolumeGeometry geometry;
  std::string type;  // "short", "float"
  bool is_compressed = false;
  std::optional<bool> big_endian;  // as it says
};

/// Reads up to the empty line before the voxels.
Expected<NrrdHeader> read_nrrd_header(std::istream& in);

/// Of 16-bit numbers, raw, little endian, in LPS, lengths in millimetres; the empty line with it.
std::string nrrd_header_of(const VolumeGeometry& geometry);

}  // namespace armature
