// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace armature {

/// What the exception says that is being handled; of foreign code, which may throw anything.
std::string current_exception_text();

/// Throws what is being handled as an exception of this library: a ConfigError or a SetupError as
/// it is, anything else as a SetupError that begins with `who`; of a plugin in `slot` it is a
/// SlotError. An exception whose type a plugin
/// defines must not outlive the plugin's library, which holds the code that destroys it.
[[noreturn]] void throw_as_own(const std::string& who, std::string_view slot = {});

}  // namespace armature
