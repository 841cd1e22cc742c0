// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// The last resort at the end of a process. Ending calls code that may wait for ever on the thread
/// that ends: the stop of a driver whose arm is gone, the end of a transport. The watch is told
/// what is called, and sees when that does not return. Time in which the process itself did not run
/// is not counted.
class EndWatch {
 public:
  /// `on_hung` is called once, on a thread of the watch, with a sentence: "the stop of 'arm' has
  /// not returned for 10 s". What hangs may hold any lock, so it had better leave the process.
  EndWatch(Duration timeout, std::function<void(const std::string&)> on_hung);
  /// From here on nothing is watched. Waits for `on_hung` where that was called.
  ~EndWatch();
  EndWatch(const EndWatch&) = delete;
  EndWatch& operator=(const EndWatch&) = delete;

  /// What is called next: "the stop of 'arm'". What was called before has returned; if that has
  /// just been told to hang, this waits until `on_hung` returns.
  void begin(const std::string& what);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace armature
