// SPDX-License-Identifier: Apache-2.0
#include "interned_text.hpp"

#include <mutex>
#include <set>
#include <string>

#include "armature/values/utf8.hpp"

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

}  // namespace

std::optional<std::string_view> lasting_label(std::string_view label) {
  constexpr std::size_t kMax = 256, kLongest = 100;
  static Kept labels{kMax};
  return label.size() > kLongest ? std::nullopt : labels.keep(label);
}

std::optional<std::string_view> lasting_detail(std::string_view text) {
  constexpr std::size_t kMax = 1024, kLongest = 500;
  static Kept details{kMax};
  return details.keep(beginning_of(text, kLongest));
}

}  // namespace armature::ik::process
