// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>
#include <type_traits>
#include <utility>

#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

namespace detail {
template <class T>
struct OrReason {
  using Type = Expected<T>;
};
template <class T>
struct OrReason<Expected<T>> {
  using Type = Expected<T>;
};
}  // namespace detail

/// What a plugin answers; an exception out of it is a reason like any other: the next call goes on.
/// `call` takes nothing and returns a value or an Expected. Costs nothing until something is
/// thrown.
template <class Call>
auto guarded(Call&& call) -> typename detail::OrReason<std::invoke_result_t<Call>>::Type {
  try {
    return std::forward<Call>(call)();
  } catch (const std::exception& error) {
    return refuse(std::string{"the plugin threw: "} + error.what());
  } catch (...) {
    return refuse("the plugin threw what is no std::exception");
  }
}

/// The same for a plugin that remembers: `call(state)`. What it remembered when it threw is not to
/// be relied on, so it starts cold.
template <class State, class Call>
auto guarded(State& state, Call&& call) ->
    typename detail::OrReason<std::invoke_result_t<Call, State&>>::Type {
  bool returned = false;
  auto answer = guarded([&] {
    auto value = std::forward<Call>(call)(state);
    returned = true;
    return value;
  });
  if (!returned) state = State{};
  return answer;
}

}  // namespace armature
