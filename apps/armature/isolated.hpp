// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace armature {

/// What became of work in a child process.
struct Isolated {
  std::string result;  // what the work returned
  std::string fault;   // why it returned nothing: "killed by signal 11 (Segmentation fault)"
};

/// Does `work` in a child process, which may crash or hang without taking this one with it; it is
/// killed after `timeout_s`. What it prints on standard output is lost. To be called by a process
/// with one thread.
Isolated isolated(double timeout_s, const std::function<std::string()>& work);

}  // namespace armature
