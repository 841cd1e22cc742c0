// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace armature::ik::process {

/// Lines for our standard error, each behind a name. They do not wait for a reader: what there is
/// no room for is dropped, and counted in a line of its own as soon as there is. One thread at a
/// time; not real-time safe.
///
/// Room is looked for before each write. A writer elsewhere in this process that takes the last of
/// it in between makes this one wait all the same: a pipe offers no better without changing it for
/// everybody.
class StandardError {
 public:
  explicit StandardError(std::string name);

  /// A line without its end; one that is too long for a pipe to take at once becomes several.
  void put(std::string_view line);
  /// The line that counts what was dropped, if there is room by now.
  void tell_dropped();

 private:
  bool write_at_once(std::string_view line) const;

  std::string name_;
  std::uint64_t dropped_ = 0;
};

}  // namespace armature::ik::process
