// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace armature {

/// Reads plain CDR (XCDR1) of either byte order. Past the end it reads zeros and remembers that it
/// failed, so a caller checks once.
class CdrReader {
 public:
  static constexpr std::size_t kHeaderSize = 4;

  /// `cdr` begins with the encapsulation header; other encodings than plain CDR fail at once.
  explicit CdrReader(std::span<const std::byte> cdr) : cdr_{cdr} {
    const bool plain = cdr.size() >= kHeaderSize && cdr[0] == std::byte{0} &&
                       (cdr[1] == std::byte{0} || cdr[1] == std::byte{1});
    ok_ = plain;
    swap_ = plain && (cdr[1] == std::byte{1}) != (std::endian::native == std::endian::little);
  }

  bool ok() const { return ok_; }
  std::size_t position() const { return at_; }
  std::size_t remaining() const { return ok_ ? cdr_.size() - at_ : 0; }

  template <class Number>
  Number number() {
    const std::span<const std::byte> bytes = take(sizeof(Number), 1);
    if (bytes.empty()) return Number{};
    std::byte raw[sizeof(Number)];
    std::memcpy(raw, bytes.data(), sizeof raw);
    if (swap_) std::reverse(std::begin(raw), std::end(raw));
    return std::bit_cast<Number>(raw);
  }

  /// `count` elements of `size` bytes each (a basic type's size, which is its alignment too).
  std::span<const std::byte> take(std::size_t size, std::size_t count) {
    if (count == 0) return {};
    const std::size_t padding = (size - (at_ - kHeaderSize) % size) % size;
    if (padding > remaining() || count > (remaining() - padding) / size) {
      ok_ = false;
      return {};
    }
    const auto taken = cdr_.subspan(at_ + padding, size * count);
    at_ += padding + size * count;
    return taken;
  }

  /// A string: its length counts the terminating zero, which is cut off.
  std::string_view text() {
    const std::size_t length = number<std::uint32_t>();
    const auto bytes = take(1, length);
    std::string_view view{reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    if (view.ends_with('\0')) view.remove_suffix(1);
    return view;
  }

 private:
  std::span<const std::byte> cdr_;
  std::size_t at_ = kHeaderSize;
  bool swap_ = false;
  bool ok_ = false;
};

}  // namespace armature
