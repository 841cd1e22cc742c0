// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/component/random_message.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

namespace armature {
namespace {

/// Writes a message field by field, little endian, every number at a multiple of its size.
class RandomWriter {
 public:
  RandomWriter(RandomNumbers numbers, std::mt19937_64& random)
      : numbers_{numbers}, random_{random} {}

  void structure(const TypeDescription& type) {
    for (const FieldDescription& field : type.fields) this->field(field);
  }
  std::vector<std::byte> take() { return std::move(cdr_); }

 private:
  std::uint64_t below(std::uint64_t bound) { return random_() % bound; }

  void field(const FieldDescription& field) {
    std::uint64_t count = 1;
    if (field.shape == FieldDescription::Shape::array) count = field.bound;
    if (field.shape == FieldDescription::Shape::sequence) {
      count = below(4) == 0 ? below(1 + kLongest) : usual_length_;
      if (field.bound != 0) count = std::min<std::uint64_t>(count, field.bound);
      number(static_cast<std::uint32_t>(count));
    }
    for (std::uint64_t i = 0; i < count; ++i) element(field);
  }

  void element(const FieldDescription& field) {
    switch (field.kind) {
      case FieldKind::boolean: return number(static_cast<std::uint8_t>(below(2)));
      case FieldKind::octet: return integer<std::uint8_t>();
      case FieldKind::int8: return integer<std::int8_t>();
      case FieldKind::int16: return integer<std::int16_t>();
      case FieldKind::uint16: return integer<std::uint16_t>();
      case FieldKind::int32: return integer<std::int32_t>();
      case FieldKind::uint32: return integer<std::uint32_t>();
      case FieldKind::int64: return integer<std::int64_t>();
      case FieldKind::uint64: return integer<std::uint64_t>();
      case FieldKind::float32: return number(static_cast<float>(real()));
      case FieldKind::float64: return number(real());
      case FieldKind::text: return text();
      case FieldKind::structure: return structure(*field.structure);
    }
  }

  double real() {
    using Limits = std::numeric_limits<double>;
    if (numbers_ == RandomNumbers::none) return Limits::quiet_NaN();
    if (numbers_ == RandomNumbers::any && below(3) == 0) {
      constexpr std::array kOdd{Limits::quiet_NaN(),
                                Limits::infinity(),
                                -Limits::infinity(),
                                1e300,
                                -1e300,
                                Limits::denorm_min(),
                                0.0,
                                -0.0};
      return kOdd[below(kOdd.size())];
    }
    return std::uniform_real_distribution<double>{-2, 2}(random_);
  }

  template <class Integer>
  void integer() {
    number(static_cast<Integer>(below(2) == 0 ? below(5) : random_()));
  }

  void text() {
    constexpr std::string_view kLetters = "abcxyz_/ 019.";
    const std::uint64_t length = below(13);
    number(static_cast<std::uint32_t>(length + 1));
    for (std::uint64_t i = 0; i < length; ++i) {
      number(static_cast<std::uint8_t>(kLetters[below(kLetters.size())]));
    }
    number(std::uint8_t{0});
  }

  template <class Number>
  void number(Number value) {
    static_assert(std::endian::native == std::endian::little);
    constexpr std::size_t kHeader = 4;
    while ((cdr_.size() - kHeader) % sizeof(Number) != 0) cdr_.push_back(std::byte{0});
    for (const std::byte byte : std::bit_cast<std::array<std::byte, sizeof(Number)>>(value)) {
      cdr_.push_back(byte);
    }
  }

  static constexpr std::uint64_t kLongest = 8;
  RandomNumbers numbers_;
  std::mt19937_64& random_;
  // Of most sequences of this message: names and positions that do not match say little.
  std::uint64_t usual_length_ = below(1 + kLongest);
  std::vector<std::byte> cdr_{std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
};

}  // namespace

std::vector<std::byte> random_message(const TypeDescription& type, RandomNumbers numbers,
                                      std::mt19937_64& random) {
  RandomWriter writer{numbers, random};
  writer.structure(type);
  return writer.take();
}

}  // namespace armature
