// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <memory>

#include "armature/values/expected.hpp"

namespace armature ARMATURE_EXPORT {

/// What a plugin library exports besides its manifest: which contract its class implements and
/// how to make one.
struct PluginEntry {
  const char* kind;
  void (*factory)();
};

namespace detail {

/// Factory signatures, taken apart: a class either has `static Expected<unique_ptr<Kind>>
/// make(args...)` (it may refuse) or a constructor from the same arguments.
template <class Plugin, class Signature>
struct PluginFactory;

template <class Plugin, class Kind, class... Args>
struct PluginFactory<Plugin, Expected<std::unique_ptr<Kind>> (*)(Args...)> {
  static Expected<std::unique_ptr<Kind>> call(Args... args) {
    if constexpr (requires { Plugin::make(args...); }) {
      return Plugin::make(args...);
    } else if constexpr (std::constructible_from<Plugin, Args...>) {
      return std::make_unique<Plugin>(args...);
    } else {
      return std::make_unique<Plugin>();
    }
  }
};

template <class Plugin, class Kind, class Arg>
struct PluginFactory<Plugin, std::unique_ptr<Kind> (*)(Arg&)> {
  static std::unique_ptr<Kind> call(Arg& arg) {
    if constexpr (requires { Plugin::make(arg); }) {
      return Plugin::make(arg);
    } else {
      return std::make_unique<Plugin>(arg);
    }
  }
};

template <class Plugin>
PluginEntry plugin_entry() {
  return {Plugin::kKind.data(),
          reinterpret_cast<void (*)()>(&PluginFactory<Plugin, typename Plugin::Factory>::call)};
}

}  // namespace detail
}  // namespace armature

/// The one registration line of a plugin: `ARMATURE_PLUGIN(armature::LampGeometric);` at global
/// scope, once per library. Id, kind, parameters and ports stand in the plugin.yaml beside it.
#define ARMATURE_PLUGIN(Class)                                                                   \
  extern "C" [[gnu::visibility("default")]] const ::armature::PluginEntry armature_plugin_entry; \
  const ::armature::PluginEntry armature_plugin_entry = ::armature::detail::plugin_entry<Class>()
