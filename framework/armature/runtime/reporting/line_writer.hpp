// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// Lines on their way to a file: any thread puts them into a bounded queue, one thread of its own
/// writes them. A reader who does not read makes that thread wait and nobody else.
class LineWriter {
 public:
  /// Longer lines are cut.
  static constexpr std::size_t kMaxLine = 1000;
  /// So many lines can wait; further ones are dropped and counted.
  static constexpr std::size_t kCapacity = 256;

  /// Writes to `file`, an open descriptor. `dropped_line` makes the line that tells how many were
  /// lost, as soon as one can be written again; it is called on the writing thread.
  LineWriter(int file, std::function<std::string(std::uint64_t)> dropped_line);
  /// Leaves what has not been written; see `flush`.
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  /// Takes one line, without its end. Never waits and never allocates: real-time safe, any thread.
  void put(std::string_view line);
  /// Waits until every line has been written, or the file takes none any more; at most `timeout`.
  void flush(Duration timeout);
  /// True when the file takes no lines any more: the terminal was closed, or the pipe's reader.
  bool closed() const;

 private:
  struct Queue;
  std::shared_ptr<Queue> queue_;  // shared with the thread, which may hang in a write for ever
};

/// True when nobody reads what is written to `file` any more. Asked without writing.
bool is_reader_gone(int file);

}  // namespace armature
