// SPDX-License-Identifier: Apache-2.0
#include "interned_text.hpp"

#include <algorithm>
#include <mutex>
#include <set>
#include <string>

namespace armature::ik::process {
namespace {

/// Texts that stay, as long as there are few.
class Kept {
 public:
  explicit Kept(std::size_t most) : most_{most} {}

  /// `text` where it stays; none when `most` others are there already.
  std::optional<std::string_view> keep(std::string_view text) {
    const std::lock_guard lock{mutex_};
    const auto known = texts_.find(text);
    if (known != texts_.end()) return *known;
    if (texts_.size() == most_) return std::nullopt;
    return *texts_.emplace(text).first;
  }

 private:
  const std::size_t most_;
  std::mutex mutex_;
  std::set<std::string, std::less<>> texts_;
};

/// The first `most` bytes, whole characters of UTF-8 only.
std::string_view cut(std::string_view text, std::size_t most) {
  std::size_t length = std::min(text.size(), most);
  const auto within_character = [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) == 0x80;
  };
  while (length > 0 && length < text.size() && within_character(text[length])) --length;
  return text.substr(0, length);
}

}  // namespace

std::optional<std::string_view> lasting_label(std::string_view label) {
  constexpr std::size_t kMax = 256, kLongest = 100;
  static Kept labels{kMax};
  return label.size() > kLongest ? std::nullopt : labels.keep(label);
}

std::optional<std::string_view> lasting_detail(std::string_view text) {
  constexpr std::size_t kMax = 1024, kLongest = 500;
  static Kept details{kMax};
  return details.keep(cut(text, kLongest));
}

}  // namespace armature::ik::process
