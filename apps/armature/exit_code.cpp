// SPDX-License-Identifier: Apache-2.0
#include "exit_code.hpp"

#include <cstdio>
#include <exception>

#include "armature/config/problems.hpp"
#include "armature/runtime/plugin_registry.hpp"

namespace armature {

int exit_code_of(const std::function<int()>& action) {
  try {
    return action();
  } catch (const config::ConfigError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return kInvalidConfig;
  } catch (const InvalidChoice& error) {
    std::fprintf(stderr, "armature: %s\n", error.what());
    return kInvalidConfig;
  } catch (const PluginError& error) {
    std::fprintf(stderr, "armature: %s\n", error.what());
    return kUnusablePlugin;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "armature: %s\n", error.what());
    return kFailed;
  }
}

}  // namespace armature
