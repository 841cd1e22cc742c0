// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace armature {

/// What the exception says that is being handled; of foreign code, which may throw anything.
std::string current_exception_text();

}  // namespace armature
