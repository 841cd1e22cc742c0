// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace armature ARMATURE_EXPORT {

/// What a process was found to hold on to after many equal cycles, beside what it held after the
/// first few of them.
struct LeakCheck {
  int cycles = 0;
  long mappings = 0;          // of memory, as in /proc/self/maps
  long heap_bytes = 0;        // handed out by malloc and not freed
  long resident_bytes = 0;    // in RAM, backed by no file
  bool still_mapped = false;  // the library is loaded although nobody holds it

  /// Why this is growth; empty: nothing was left behind. Allowed are 1 byte a cycle of heap, 64 KiB
  /// of resident memory, which the kernel counts by pages and late, and no mapping.
  std::string fault() const;
};

/// Calls `cycle` up to `cycles` times, fewer when that takes longer than `budget_s`. `library` must
/// be loaded by nobody before and after. Under a sanitizer only `still_mapped` is found out.
LeakCheck check_for_leaks(const std::filesystem::path& library, int cycles, double budget_s,
                          const std::function<void()>& cycle);

}  // namespace armature
