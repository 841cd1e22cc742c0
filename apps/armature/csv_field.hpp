// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace armature {

/// `text` as a field of a CSV (RFC 4180).
inline std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string{"\"\""} : std::string{c};
  return quoted + '"';
}

}  // namespace armature
