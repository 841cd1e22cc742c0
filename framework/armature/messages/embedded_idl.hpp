// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <iterator>
#include <string_view>

namespace armature {

/// The text of the index-th file of idl/, in the order of their includes; empty after the last.
std::string_view embedded_idl(std::size_t index);

}  // namespace armature
