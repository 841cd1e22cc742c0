// SPDX-License-Identifier: Apache-2.0
#include "verbs/option_checks.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <regex>
#include <system_error>

#include "armature/bus/network.hpp"
#include "armature/config/problems.hpp"
#include "armature/values/utf8.hpp"
#include "armature/web/web_server.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

/// The number that is all of `text`.
template <class Number>
bool reads_as(const std::string& text, Number& number) {
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  return read.ec == std::errc{} && read.ptr == end;
}

}  // namespace

std::string wrong_seed(const std::string& text) {
  std::uint64_t seed = 0;
  if (reads_as(text, seed)) return "";
  return "must be a whole number from 0 to 18446744073709551615, not '" + text + "'";
}

std::string wrong_number(const std::string& text) {
  double number = 0;
  if (reads_as(text, number) && std::isfinite(number)) return "";
  return "must be a finite number, not '" + text + "'";
}

std::string no_name(const std::string& text) {
  return text.empty() ? "names nothing: is a variable of the shell empty?" : "";
}

std::string no_token(const std::string& text) {
  if (text.size() <= WebServer::kMaxTokenBytes) return "";
  return fmt::format("has {} bytes; at most {} are taken", text.size(), WebServer::kMaxTokenBytes);
}

std::string no_prefix(const std::string& text) {
  static const std::regex kNames{"(/[A-Za-z_][A-Za-z0-9_]*)+"};
  if (std::regex_match(text, kNames)) return "";
  return "must be names behind '/', of letters, digits and _, as in /replay, not '" +
         terminal_text(text) + "'";
}

std::string not_positive(const std::string& text) {
  double number = 0;
  if (reads_as(text, number) && std::isfinite(number) && number > 0) return "";
  return "must be a positive number, not '" + text + "'";
}

std::string no_interface(const std::string& text) {
  const auto found = find_interfaces({text});
  return found ? "" : found.error().text;
}

std::string no_host(const std::string& text) {
  const auto possible = check_host_name(text);
  return possible ? "" : possible.error().text;
}

std::string no_server(const std::string& text) {
  const auto possible = read_server_address(text);
  return possible ? "" : possible.error().text;
}

std::string no_pattern(const std::string& text) {
  const std::size_t star = text.find('*');
  return star == std::string::npos || star + 1 == text.size()
             ? ""
             : config::in_quotes(text) + " has a '*' that is not at its end";
}

std::string no_file(const std::string& text) {
  return text == "-" ? "is written into a file only, not to standard output; for a file of that "
                       "name say ./-"
                     : "";
}

std::string no_text(const std::string& text) {
  return is_utf8(text) ? "" : "'" + terminal_text(text) + "' is not UTF-8, as text on topics is";
}

std::string no_hash(const std::string& text) {
  constexpr std::size_t kDigits = 64;
  const bool is_one =
      text.size() == kDigits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
  return is_one ? "" : config::in_quotes(text) + " is no SHA-256, 64 hexadecimal digits";
}

std::string in_small_letters(std::string text) {
  for (char& letter : text) {
    if (letter >= 'A' && letter <= 'F') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return text;
}

}  // namespace armature
