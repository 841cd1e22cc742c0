// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <string_view>

#include "armature/runtime/execution/clock.hpp"
#include "armature/runtime/reporting/line_writer.hpp"

namespace armature {

/// Lines for the operator on standard error, with the deployment's time; from any thread, and none
/// of them ever waits for whoever reads them.
class Console {
 public:
  Console();
  /// Writes the lines that still wait; gives up after 0.5 s.
  ~Console() { flush(); }
  void flush() { lines_.flush(seconds(0.5)); }

  /// From here on lines say how long it is after `start`.
  void start(const Clock& clock, Time start);
  /// A line of a component, or of the runtime. Real-time safe.
  void line(std::string_view who, std::string_view text);
  /// A line of the program itself: "armature: interrupted".
  void tell(std::string_view text);
  /// Which of the standard streams has nobody to read it any more, if one has lost its reader: the
  /// terminal was closed, or the program behind `|` has ended.
  std::optional<std::string> lost_reader() const;

 private:
  Time start_;  // of clock_
  std::atomic<const Clock*> clock_{nullptr};
  LineWriter lines_;
};

}  // namespace armature
