// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace armature::config {

/// What yaml-cpp lets pass in a quoted scalar: a quote that is never closed, an escape that makes a
/// control character.
struct QuotedFault {
  std::size_t offset;
  std::string message;
};

/// The first fault of the quoted scalar that `text` starts with.
std::optional<QuotedFault> fault_of_quoted(std::string_view text);

}  // namespace armature::config
