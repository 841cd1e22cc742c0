// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature {

/// The contents of the named sections of a 64-bit ELF shared library, as text up to the first NUL;
/// sections that are not there are left out. Reads the file only: none of its code is run. Any
/// file may be given; what is no such library answers with a reason.
Expected<std::map<std::string, std::string>> read_elf_sections(
    const std::filesystem::path& file, const std::vector<std::string_view>& names);

}  // namespace armature
