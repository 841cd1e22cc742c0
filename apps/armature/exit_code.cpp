// SPDX-License-Identifier: Apache-2.0
#include "exit_code.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "armature/config/problems.hpp"
#include "armature/runtime/plugins/exit_guard.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "colour.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {

namespace {

/// What was printed and never arrived was not done: a full disk behind `>`.
int printed(int code) {
  errno = 0;
  const bool lost = std::fflush(standard_output()) != 0 || std::ferror(standard_output()) != 0;
  if (!lost) return code;
  std::fprintf(stderr, "armature: standard output cannot be written%s%s\n", errno ? ": " : "",
               errno ? std::strerror(errno) : "");
  return kFailed;
}

}  // namespace

int exit_code_of(const std::exception& error) {
  const bool wrong_file = dynamic_cast<const config::ConfigError*>(&error) != nullptr;
  if (wrong_file || dynamic_cast<const InvalidChoice*>(&error)) return kInvalidConfig;
  return dynamic_cast<const PluginError*>(&error) ? kUnusablePlugin : kFailed;
}

int exit_code_of(const std::function<int()>& action) {
  keep_standard_output();
  const ExitGuard guard{
      [](const std::string& what) { std::fprintf(stderr, "armature: %s\n", what.c_str()); }};
  try {
    return printed(action());
  } catch (const config::ConfigError& error) {  // whose lines begin with their place
    std::fprintf(stderr, "%s\n", error.what());
    return exit_code_of(error);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s %s\n", coloured("armature:", Tone::bad, stderr).c_str(),
                 terminal_lines(error.what(), 0).c_str());
    return exit_code_of(error);
  }
}

}  // namespace armature
