// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace armature {

// What there is to say of a run without figures: it did not begin, or its end hangs.

/// Where report.json stands in the folder of a report.
std::filesystem::path report_file(const std::filesystem::path& folder);

/// As JSON, `reason` may be "".
std::string ending(std::string_view status, const std::string& reason);

/// Writes it where the report would be. A folder that takes no file is told on stderr.
void write_ending(const std::filesystem::path& folder, const std::string& ending);

}  // namespace armature
