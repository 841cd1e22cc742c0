// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>

#include "armature/runtime/processes/end_watch.hpp"
#include "run/console.hpp"
#include "run/run.hpp"
#include "run/run_watches.hpp"

namespace armature {

/// Watches the end of a process. Where a part of it does not return, the process says which, puts
/// that where its result would be unless the result has been told, and leaves.
class WatchedEnd {
 public:
  /// Keeps references. `child` is nullptr in the main process.
  WatchedEnd(const RunOptions& options, Console& console, ChildWatch* child);

  void begin(const std::string& what) { watch_->begin(what); }
  void result_told() { result_told_ = true; }
  /// For work on files, which takes as long as they are; `work` throws nothing.
  void do_unwatched(const std::function<void()>& work);
  /// Tells a fault that leaves nothing to wait for, and leaves. The thread that ends may hold the
  /// lock of a standard stream.
  [[noreturn]] void leave(const std::string& fault) const;

 private:
  void watch();

  const RunOptions* options_;
  Console* console_;
  ChildWatch* child_;
  std::atomic<bool> result_told_{false};
  std::optional<EndWatch> watch_;
};

}  // namespace armature
