// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace armature ARMATURE_EXPORT {

/// Counts the bytes of an encoding in plain CDR: a message is serialised into it as into an
/// encoder.
class CdrSize {
 public:
  /// Without the encapsulation header.
  std::size_t bytes() const { return at_; }

  template <class Element>
  CdrSize& operator<<(const Element& element) {
    if constexpr (std::is_arithmetic_v<Element>) {
      numbers<Element>(1);
    } else {
      element.serialize(*this);
    }
    return *this;
  }
  CdrSize& operator<<(const std::string& text) {
    numbers<std::uint32_t>(1);
    at_ += text.size() + 1;
    return *this;
  }
  template <class Element, std::size_t size>
  CdrSize& operator<<(const std::array<Element, size>& elements) {
    return all(elements);
  }
  template <class Element>
  CdrSize& operator<<(const std::vector<Element>& elements) {
    numbers<std::uint32_t>(1);
    return all(elements);
  }

 private:
  template <class Elements>
  CdrSize& all(const Elements& elements) {
    using Element = typename Elements::value_type;
    if constexpr (std::is_arithmetic_v<Element>) {
      numbers<Element>(elements.size());
    } else {
      for (const Element& element : elements) *this << element;
    }
    return *this;
  }
  template <class Number>
  void numbers(std::size_t count) {
    if (count > 0) at_ += (sizeof(Number) - at_ % sizeof(Number)) % sizeof(Number);
    at_ += count * sizeof(Number);
  }

  std::size_t at_ = 0;
};

}  // namespace armature
