// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <type_traits>
#include <utility>

namespace armature ARMATURE_EXPORT {

/// Why something could not be done. For a human: what was wrong, with the value and its unit. For a
/// program: a code whose meanings the answering kind defines; 0 where there is nothing to tell
/// apart.
struct Reason {
  std::string text;
  std::uint8_t code = 0;
};

/// A value, or the reason why there is none. What computations in the running graph return.
template <class T>
using Expected = tl::expected<T, Reason>;

/// `return refuse("0.034 m beyond reach");`
inline tl::unexpected<Reason> refuse(std::string text) {
  return tl::unexpected<Reason>{Reason{.text = std::move(text)}};
}

/// The same with a code of the kind: `return refuse(FaceRefusal::covered, "the mouth lies ...");`
template <class Code>
requires std::is_enum_v<Code> tl::unexpected<Reason> refuse(Code code, std::string text) {
  return tl::unexpected<Reason>{
      Reason{.text = std::move(text), .code = static_cast<std::uint8_t>(code)}};
}

}  // namespace armature
