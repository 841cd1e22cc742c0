// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <utility>

#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {

/// As print_out, of lines with names that a recording tells, which a terminal must not obey.
template <class... Values>
void print_recorded(fmt::format_string<Values...> format, Values&&... values) {
  print_out("{}", terminal_lines(fmt::format(format, std::forward<Values>(values)...), 0));
}

}  // namespace armature
