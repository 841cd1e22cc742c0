// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <functional>
#include <stdexcept>

namespace armature {

// What `armature` ends with.
inline constexpr int kOk = 0;
inline constexpr int kFailed = 1;          // at run time
inline constexpr int kUsage = 2;           // of the command line
inline constexpr int kInvalidConfig = 3;   // a file or a name in it, an unknown plugin id too
inline constexpr int kUnusablePlugin = 4;  // a library that is there but cannot be used
inline constexpr int kTimedOut = 5;

/// A name on the command line that means nothing here (exit code 3).
class InvalidChoice : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a command ends with that ended with `error`.
int exit_code_of(const std::exception& error);
/// What `action` ends with; an exception is told on standard error and has its own code.
int exit_code_of(const std::function<int()>& action);

}  // namespace armature
