// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace armature {

/// The folder of the library that this code lives in, in a build tree and after installation. The
/// framework's own plugins and helper programs lie in `armature/` below it.
std::filesystem::path library_folder();
/// The library itself.
std::filesystem::path library_file();

}  // namespace armature
