// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>

#include "alignment_monitor.hpp"

namespace armature::report::lamp_alignment {

/// All errors over time as CSV, in SI; what is not known is empty. Throws std::runtime_error when
/// the file cannot be written.
void write_error_table(std::span<const LampError> errors, const std::filesystem::path& file);

}  // namespace armature::report::lamp_alignment
