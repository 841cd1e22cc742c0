// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace armature ARMATURE_EXPORT {

/// The name of this processor's instruction set, "x86-64-v3": solvers choose instructions by it,
/// and the last bits of their answers depend on it.
std::string processor_level();

/// The library that does the work of `library` on a processor of `level`: NAME.so of a folder
/// beside it that is named by a level, "x86-64-v3/NAME.so", the highest that is no higher; else
/// itself. So each library holds the code of one level: templates of two levels in one library
/// would break the rule of one definition.
std::filesystem::path library_for(std::string_view level, const std::filesystem::path& library);

}  // namespace armature
