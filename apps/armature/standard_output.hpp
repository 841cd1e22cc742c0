// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <utility>

namespace armature {

/// Where the program prints its results: standard output as the caller gave it.
std::FILE* standard_output();
/// Its descriptor. Safe in a signal handler.
int standard_output_descriptor();
/// Writes as much as a reader takes at once. Safe in a signal handler.
void write_at_once(int file, std::string_view text);

/// Prints a part of the result.
template <class... Arguments>
void print_out(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
  fmt::print(standard_output(), text, std::forward<Arguments>(arguments)...);
}

/// From now on standard_output() is the program's own, and what anybody else prints on standard
/// output, a plugin or a program that it starts, goes to standard error: it would stand in the
/// middle of a result that another program reads. To be called once, with one thread.
void keep_standard_output();

}  // namespace armature
