// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace armature {

enum class Tone { good, doubtful, bad };

/// `text` in green, yellow or red where `stream` is a terminal; as it is elsewhere, and where
/// NO_COLOR is set (no-color.org) or TERM is "dumb".
std::string coloured(std::string_view text, Tone tone, std::FILE* stream);

}  // namespace armature
