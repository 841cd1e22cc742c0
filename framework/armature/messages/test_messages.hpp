// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "armature/messages/message_type.hpp"
#include "armature/messages/type_description.hpp"

namespace armature ARMATURE_EXPORT {

/// Writes a valid encoding with random content, driven by the description alone.
class RandomCdr {
 public:
  explicit RandomCdr(std::uint32_t seed) : random_{seed} {}

  std::vector<std::byte> of(const TypeDescription& type) {
    cdr_ = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
    structure(type);
    return cdr_;
  }

 private:
  void structure(const TypeDescription& type) {
    for (const FieldDescription& field : type.fields) {
      std::uint32_t count = 1;
      if (field.shape == FieldDescription::Shape::array) count = field.bound;
      if (field.shape == FieldDescription::Shape::sequence) {
        count = static_cast<std::uint32_t>(random_() % 4);
        number(count);
      }
      for (std::uint32_t i = 0; i < count; ++i) element(field);
    }
  }
  void element(const FieldDescription& field) {
    switch (field.kind) {
      case FieldKind::boolean: return number(static_cast<std::uint8_t>(random_() % 2));
      case FieldKind::octet:
      case FieldKind::int8: return number(static_cast<std::uint8_t>(random_()));
      case FieldKind::int16:
      case FieldKind::uint16: return number(static_cast<std::uint16_t>(random_()));
      case FieldKind::int32:
      case FieldKind::uint32: return number(static_cast<std::uint32_t>(random_()));
      case FieldKind::int64:
      case FieldKind::uint64: return number(std::uint64_t{random_()} << 20 | random_());
      case FieldKind::float32: return number(static_cast<float>(random_()) * 1e-3F);
      case FieldKind::float64: return number(static_cast<double>(random_()) * 1e-3);
      case FieldKind::text: return text();
      case FieldKind::structure: return structure(*field.structure);
    }
  }
  void text() {
    const std::uint32_t length = static_cast<std::uint32_t>(random_() % 7);
    number(length + 1);
    for (std::uint32_t i = 0; i < length; ++i) cdr_.push_back(std::byte{'a'});
    cdr_.push_back(std::byte{0});
  }
  template <class Number>
  void number(Number value) {
    while ((cdr_.size() - 4) % sizeof value != 0) cdr_.push_back(std::byte{0});
    const auto* bytes = reinterpret_cast<const std::byte*>(&value);
    cdr_.insert(cdr_.end(), bytes, bytes + sizeof value);
  }

  std::mt19937 random_;
  std::vector<std::byte> cdr_;
};

struct AnyMessage {
  explicit AnyMessage(const MessageType& of) : type{of}, message{of.create()} {}
  AnyMessage(const AnyMessage&) = delete;
  AnyMessage& operator=(const AnyMessage&) = delete;
  ~AnyMessage() { type.destroy(message); }
  const MessageType& type;
  void* message;
};

}  // namespace armature
