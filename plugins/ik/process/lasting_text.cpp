// SPDX-License-Identifier: Apache-2.0
#include "lasting_text.hpp"

#include <algorithm>
#include <array>
#include <mutex>
#include <set>
#include <string>

namespace armature::process {

std::optional<std::string_view> lasting_label(std::string_view label) {
  constexpr std::size_t kMost = 256, kLongest = 100;
  static std::mutex mutex;
  static std::set<std::string, std::less<>> labels;
  const std::lock_guard lock{mutex};
  const auto known = labels.find(label);
  if (known != labels.end()) return *known;
  if (labels.size() == kMost || label.size() > kLongest) return std::nullopt;
  return *labels.emplace(label).first;
}

std::string_view lasting_detail(std::string_view text) {
  // Without a destructor, so that no thread keeps the library loaded.
  static thread_local std::array<char, 500> kept;
  std::size_t length = std::min(text.size(), kept.size());
  const auto within_character = [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) == 0x80;
  };
  while (length > 0 && length < text.size() && within_character(text[length])) --length;
  std::copy_n(text.begin(), length, kept.begin());
  return {kept.data(), length};
}

}  // namespace armature::process
