// SPDX-License-Identifier: Apache-2.0
#include "armature/laws/leak_check.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <chrono>
#include <fstream>

#include "armature/values/sanitizer.hpp"

namespace armature {
namespace {

constexpr int kWarmUp = 20;  // what is allocated once is there after these
constexpr long kResidentAllowed = 64 * 1024;

long heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<long>(info.uordblks + info.hblkhd);
}

/// Of memory that no file backs: pages of libraries are mapped ahead of use, and are no leaks.
long resident_bytes() {
  std::ifstream rollup{"/proc/self/smaps_rollup"};
  for (std::string word; rollup >> word;) {
    if (word != "Anonymous:") continue;
    long kibibytes = 0;
    rollup >> kibibytes;
    return kibibytes * 1024;
  }
  return 0;
}

long mappings() {
  long count = 0;
  std::ifstream maps{"/proc/self/maps"};
  for (std::string line; std::getline(maps, line);) ++count;
  return count;
}

bool is_mapped(const std::filesystem::path& library) {
  const std::string file = std::filesystem::canonical(library).string();
  std::ifstream maps{"/proc/self/maps"};
  for (std::string line; std::getline(maps, line);) {
    if (line.ends_with(file)) return true;
  }
  return false;
}

}  // namespace

std::string LeakCheck::fault() const {
  if (still_mapped) {
    return "the library stays loaded after the last of its objects is gone (a unique symbol, or a "
           "thread or exit handler of its own, holds it)";
  }
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
  if (mappings > 0) add(fmt::format("{} mappings", mappings));
  if (heap_bytes > cycles) add(fmt::format("{} bytes of heap", heap_bytes));
  if (resident_bytes > kResidentAllowed) {
    add(fmt::format("{} KiB of resident memory", resident_bytes / 1024));
  }
  return text.empty() ? "" : fmt::format("{} more after {} cycles", text, cycles);
}

LeakCheck check_for_leaks(const std::filesystem::path& library, int cycles, double budget_s,
                          const std::function<void()>& cycle) {
  using Steady = std::chrono::steady_clock;
  const auto end = Steady::now() + std::chrono::duration<double>{budget_s};
  for (int i = 0; i < kWarmUp; ++i) cycle();
  LeakCheck leaks;
  leaks.mappings = -mappings();
  leaks.heap_bytes = -heap_bytes();
  leaks.resident_bytes = -resident_bytes();
  while (leaks.cycles < cycles && Steady::now() < end) {
    cycle();
    ++leaks.cycles;
  }
  leaks.resident_bytes += resident_bytes();
  leaks.heap_bytes += heap_bytes();
  leaks.mappings += mappings();
  if (kSanitized) leaks.resident_bytes = leaks.heap_bytes = leaks.mappings = 0;
  leaks.still_mapped = is_mapped(library);
  return leaks;
}

}  // namespace armature
