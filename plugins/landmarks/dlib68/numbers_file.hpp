// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

namespace armature::landmarks::dlib68 {

/// A file that dlib has written.
class NumbersFile final : public std::filebuf {
 public:
  explicit NumbersFile(const std::string& name) {
    pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    open(name, std::ios::in | std::ios::binary);
  }

  /// The next number, which dlib writes as mantissa * 2^exponent: two whole numbers, each a byte
  /// with its sign and its length and then its bytes, the lowest one first. False, and nothing is
  /// taken, where dlib has to be asked: at the end of the buffer and for infinity and the like.
  bool take(float& number) {
    const auto* at = reinterpret_cast<const unsigned char*>(gptr());
    if (egptr() - gptr() < kLongest) return false;
    const unsigned length = at[0] & kLength;
    if ((at[0] & ~(kLength | kNegative)) != 0 || length == 0 || length > 8) return false;
    const unsigned exponent_length = at[1 + length] & kLength;
    if (exponent_length == 0 || exponent_length > 2) return false;

    const auto mantissa = static_cast<std::int64_t>(whole_number<std::uint64_t>(at + 1, length));
    int exponent = whole_number<std::uint16_t>(at + 2 + length, exponent_length);
    if ((at[1 + length] & kNegative) != 0) exponent = -exponent;
    if (exponent < -126 || exponent > 127) return false;  // 2^exponent has no float of its own
    const auto power = std::bit_cast<float>(static_cast<std::uint32_t>(exponent + 127) << 23U);
    const auto size = static_cast<float>(mantissa) * power;
    number = (at[0] & kNegative) != 0 ? -size : size;
    gbump(static_cast<int>(2 + length + exponent_length));
    return true;
  }

 private:
  static constexpr unsigned kLength = 0x0F, kNegative = 0x80;
  static constexpr std::ptrdiff_t kLongest = 1 + 8 + 1 + 2;

  template <class Whole>
  static Whole whole_number(const unsigned char* at, unsigned length) {
    static_assert(std::endian::native == std::endian::little);
    Whole whole = 0;
    std::memcpy(&whole, at, sizeof whole);
    const unsigned unused_bits = 8 * (static_cast<unsigned>(sizeof whole) - length);
    return static_cast<Whole>(whole << unused_bits) >> unused_bits;
  }

  std::vector<char> buffer_ = std::vector<char>(1U << 20U);
};

}  // namespace armature::landmarks::dlib68
