// SPDX-License-Identifier: Apache-2.0
#include "armature/config/source_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "armature/config/problems.hpp"
#include "armature/values/utf8.hpp"

namespace armature::config {
namespace {

std::uint32_t byte_at(std::string_view text, std::size_t at) {
  return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U;
}

/// What is wrong with the character at `at`; empty: nothing.
std::string fault_at(std::string_view text, std::size_t at) {
  const std::uint32_t byte = byte_at(text, at);
  if (first_character(text.substr(at)).length == 0) {
    return fmt::format("byte 0x{:02X} is not UTF-8; save the file as UTF-8", byte);
  }
  if (byte == '\r' && byte_at(text, at + 1) != '\n') {
    return "a carriage return without a newline; save the file with Unix line ends";
  }
  const bool space = byte == '\t' || byte == '\n' || byte == '\r';
  if ((byte < 0x20 && !space) || byte == 0x7F) {
    return fmt::format("control character 0x{:02X}; is this a YAML file?", byte);
  }
  return "";
}

}  // namespace

SourceText::SourceText(std::string text, std::string name)
    : text_{std::move(text)}, name_{std::move(name)}, line_starts_{0} {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
  std::size_t at = 0;
  while (at < text_.size()) {
    const std::string fault = fault_at(text_, at);
    if (!fault.empty()) throw ConfigError{{{place(at), fault}}};
    if (text_[at] == '\n') line_starts_.push_back(at + 1);
    const std::size_t next = at + first_character(std::string_view{text_}.substr(at)).length;
    while (++at < next) continuation_bytes_.push_back(at);
  }
}

Origin SourceText::place(std::size_t byte) const {
  byte = std::min(byte, text_.size());
  const auto next = std::ranges::upper_bound(line_starts_, byte);
  const std::size_t line_start = *std::prev(next);
  const auto continuation_bytes_before = [this](std::size_t end) {
    return std::ranges::lower_bound(continuation_bytes_, end) - continuation_bytes_.begin();
  };
  const auto skipped = continuation_bytes_before(byte) - continuation_bytes_before(line_start);
  return {name_, static_cast<int>(next - line_starts_.begin()),
          1 + static_cast<int>(byte - line_start) - static_cast<int>(skipped)};
}

}  // namespace armature::config
