// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <functional>
#include <string>

namespace armature ARMATURE_EXPORT {

/// Tells, while it exists, who ends this process with exit() or quick_exit(): a plugin must not, as
/// nothing would come to rest and the exit code would be the plugin's. Of several the youngest
/// tells. It does not see _exit(), nor what a forked child does.
class ExitGuard {
 public:
  /// `tell` gets "component 'camera' ended the process (exit code 0) in its step", on the thread
  /// that called it while all others run on; then the process ends with exit code 1, and
  /// nothing more of it runs. `tell` flushes what it writes.
  explicit ExitGuard(std::function<void(const std::string& what)> tell);
  ~ExitGuard();
  ExitGuard(const ExitGuard&) = delete;
  ExitGuard& operator=(const ExitGuard&) = delete;

  /// Objects of static storage that were made before this call are still there when it tells. To be
  /// called again once libraries have been loaded.
  static void go_first();

 private:
  static void on_exit(int code, void* data);

  std::function<void(const std::string&)> tell_;
  pid_t process_;
  ExitGuard* outer_;
};

}  // namespace armature
