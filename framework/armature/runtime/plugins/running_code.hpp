// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace armature {

/// Which code of a plugin the calling thread runs: "component", "camera", "step". Constant text and
/// the name that RunningComponent was given; all nullptr outside of such code. Safe in a signal
/// handler.
struct RunningCode {
  const char* what;
  const char* name;
  const char* phase;
};
RunningCode running_code();

}  // namespace armature
