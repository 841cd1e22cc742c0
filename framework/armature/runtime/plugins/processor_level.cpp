// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/processor_level.hpp"

#include <sys/utsname.h>

#include <algorithm>
#include <array>

namespace armature {
namespace {

// From the psABI of x86-64: each has what the next one has, and more.
constexpr std::array<std::string_view, 3> kLevels{"x86-64-v4", "x86-64-v3", "x86-64-v2"};

}  // namespace

std::string processor_level() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("x86-64-v4")) return "x86-64-v4";
  if (__builtin_cpu_supports("x86-64-v3")) return "x86-64-v3";
  if (__builtin_cpu_supports("x86-64-v2")) return "x86-64-v2";
#endif
  utsname name{};
  uname(&name);
  return name.machine;
}

std::filesystem::path library_for(std::string_view level, const std::filesystem::path& library) {
  for (auto it = std::ranges::find(kLevels, level); it != kLevels.end(); ++it) {
    std::error_code none;
    auto own = library.parent_path() / *it / library.filename();
    if (std::filesystem::is_regular_file(own, none)) return own;
  }
  return library;
}

}  // namespace armature
