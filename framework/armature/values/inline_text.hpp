// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "armature/values/utf8.hpp"

namespace armature ARMATURE_EXPORT {

/// Text of at most `kCapacity` bytes that lives in place: what a control thread has to say. Longer
/// text ends in "...". Never allocates; real-time safe.
template <std::size_t kCapacity>
class InlineText {
 public:
  InlineText() = default;
  InlineText(std::string_view text) { assign(text.data(), text.size()); }  // NOLINT: implicit
  InlineText(const char* text) : InlineText{std::string_view{text}} {}     // NOLINT: implicit

  /// As fmt::format; numbers are told without the heap.
  template <class... Args>
  static InlineText format(fmt::format_string<Args...> format, Args&&... args) {
    InlineText text;
    const auto told =
        fmt::format_to_n(text.bytes_.data(), kCapacity, format, std::forward<Args>(args)...);
    text.close(told.size);
    return text;
  }

  std::string_view view() const { return {bytes_.data(), size_}; }
  operator std::string_view() const { return view(); }  // NOLINT: implicit
  bool empty() const { return size_ == 0; }
  void clear() { size_ = 0; }
  friend bool operator==(const InlineText& a, const InlineText& b) { return a.view() == b.view(); }

 private:
  void assign(const char* text, std::size_t size) {
    std::copy_n(text, std::min(size, kCapacity), bytes_.data());
    close(size);
  }
  /// `wanted`: how long the whole text would be.
  void close(std::size_t wanted) {
    constexpr std::string_view kCut = "...";
    static_assert(kCapacity > kCut.size());
    size_ = std::min(wanted, kCapacity);
    if (wanted <= kCapacity) return;
    const std::size_t kept = beginning_of(view(), kCapacity - kCut.size()).size();
    std::copy(kCut.begin(), kCut.end(), bytes_.begin() + kept);
    size_ = kept + kCut.size();
  }

  std::array<char, kCapacity> bytes_{};
  std::size_t size_ = 0;
};

/// Why something on a control thread could not be done: what was wrong, with value and unit.
using ReasonText = InlineText<240>;

}  // namespace armature
