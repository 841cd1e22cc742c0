// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace armature {

/// A JSON value of nlohmann's library as text: in one line, or a member a line, indented by so many
/// blanks. What others wrote need not be UTF-8, which the library would throw for: a byte that is
/// no character becomes U+FFFD.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace armature
