// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <utility>

#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {

/// Prints lines with names that a recording tells, and ends the last one; a terminal shows their
/// control characters and does not obey them.
template <class... Values>
void print_recorded(fmt::format_string<Values...> format, Values&&... values) {
  print_out("{}\n", terminal_lines(fmt::format(format, std::forward<Values>(values)...), 0));
}

}  // namespace armature
