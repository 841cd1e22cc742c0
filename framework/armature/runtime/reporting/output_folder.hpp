// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace armature ARMATURE_EXPORT {

/// Makes `folder`, with what is above it, and tries to write into it: before what takes long, so
/// that its result is not lost. A link on the way there is followed when it is the user's own or
/// root's: another user's would decide where root writes. Throws std::runtime_error with the
/// reason.
void prepare_output_folder(const std::filesystem::path& folder);

}  // namespace armature
