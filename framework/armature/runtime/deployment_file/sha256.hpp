// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace armature {

/// SHA-256 of `text`: 64 hexadecimal digits. Throws std::runtime_error when OpenSSL offers none.
std::string sha256(std::string_view text);

}  // namespace armature
