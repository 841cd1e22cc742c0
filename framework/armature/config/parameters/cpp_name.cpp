// SPDX-License-Identifier: Apache-2.0
#include "armature/config/parameters/cpp_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace armature {
namespace {

/// A space on either side of each.
constexpr std::string_view kTaken =
    " alignas alignof and and_eq asm auto bitand bitor bool break case catch char "
    "char16_t char32_t char8_t class co_await co_return co_yield compl concept const "
    "const_cast consteval constexpr constinit continue decltype default delete do double "
    "dynamic_cast else enum explicit export extern false float for friend goto if inline "
    "int long mutable namespace new noexcept not not_eq nullptr operator or or_eq "
    "private protected public read register reinterpret_cast requires return short "
    "signed sizeof static static_assert static_cast struct switch template this "
    "thread_local throw true try typedef typeid typename union unsigned using virtual "
    "void volatile wchar_t while xor xor_eq std armature params fmt tl ";

}  // namespace

std::string in_cpp(std::string_view name) {
  std::string in_cpp{name};
  std::ranges::replace_if(in_cpp, std::not_fn(is_in_a_name), '_');
  const bool is_taken = kTaken.find(" " + in_cpp + " ") != kTaken.npos;
  return is_taken ? in_cpp + "_" : in_cpp;
}

bool is_in_a_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

std::string namespace_of(std::string_view id) {
  std::string name = "armature";
  while (!id.empty()) {
    const std::size_t slash = std::min(id.find('/'), id.size());
    name += "::" + in_cpp(id.substr(0, slash));
    id.remove_prefix(std::min(slash + 1, id.size()));
  }
  return name;
}

std::string camel_case(std::string_view name) {
  std::string camel;
  bool is_first = true;
  for (const char c : name) {
    if (c != '_') camel += is_first && c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    is_first = c == '_';
  }
  return camel;
}

std::string literal_of(std::string_view text) {
  std::string literal = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') literal += '\\';
    if (c >= 0 && c < ' ') {
      literal += fmt::format("\\{:03o}", static_cast<int>(c));
    } else {
      literal += c;
    }
  }
  return literal + '"';
}

std::string comment_of(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  if (text.ends_with('\\')) text += '.';  // or the next line would belong to the comment
  return text.empty() ? "" : "  /// " + text + '\n';
}

}  // namespace armature
