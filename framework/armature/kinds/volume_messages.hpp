// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/values/expected.hpp"
#include "armature/volume/volume.hpp"

namespace armature ARMATURE_EXPORT {

/// SHA-256 of how the voxels lie (size, spacing, direction and origin to the nanometre) and of
/// their values: 64 hexadecimal digits. The same whatever the format that the volume was read from.
std::string sha256_of(const Volume& volume);

/// Reads the volume that `file` announces. Refuses, with the path, what cannot be read and what is
/// not the volume that was announced: somebody wrote to the file since.
Expected<Volume> volume_of(const msg::VolumeFile& file);

}  // namespace armature
