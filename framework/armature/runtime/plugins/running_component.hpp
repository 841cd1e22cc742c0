// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace armature ARMATURE_EXPORT {

/// Says, while it exists, that the calling thread runs a component's code, or that of another
/// plugin, so that a crash there can name it. Real-time safe.
class RunningComponent {
 public:
  /// `name` outlives this; `phase` and `what` are constant text: "step", "plugin".
  RunningComponent(const std::string& name, const char* phase, const char* what = "component");
  ~RunningComponent();
  RunningComponent(const RunningComponent&) = delete;
  RunningComponent& operator=(const RunningComponent&) = delete;

  /// The component whose code the calling thread runs, or nullptr. Real-time safe.
  static const char* name();

 private:
  const char* outer_name_;
  const char* outer_phase_;
  const char* outer_what_;
};

/// From now on a crash of this process (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) is first told on
/// standard error, with the component whose code the thread ran; then the process ends as it would
/// have without. A crash has no way back: only another process is safe from it. For the calling
/// thread this includes a stack overflow, for others see CrashStack.
void name_crashing_components();

/// A stack of its own for the handler, so that a stack overflow is told too; for the calling
/// thread, until it ends.
class CrashStack {
 public:
  CrashStack();
  ~CrashStack();
  CrashStack(const CrashStack&) = delete;
  CrashStack& operator=(const CrashStack&) = delete;

 private:
  void* memory_;
};

}  // namespace armature
