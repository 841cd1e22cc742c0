// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace armature ARMATURE_EXPORT {

/// Why something could not be done, for a human: what was wrong, with the value and its unit.
struct Reason {
  std::string text;
};

/// A value, or the reason why there is none. What computations in the running graph return.
template <class T>
using Expected = tl::expected<T, Reason>;

/// `return refuse("0.034 m beyond reach");`
inline tl::unexpected<Reason> refuse(std::string text) {
  return tl::unexpected<Reason>{Reason{std::move(text)}};
}

}  // namespace armature
