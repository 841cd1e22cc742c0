// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>
#include <string>

namespace armature {

/// The date and time of day in UTC.
std::tm utc(std::time_t time);

/// A date as `format` of strftime shows it; of at most 63 bytes.
std::string date_text(const std::tm& date, const char* format);

}  // namespace armature
