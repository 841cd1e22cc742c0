// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/testing/growth.hpp"

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

/// Of memory that no file backs: pages of libraries are mapped ahead of use, and are no growth.
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

std::string Growth::fault() const {
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

Growth growth_of(const std::filesystem::path& library, int cycles, double budget_s,
                 const std::function<void()>& cycle) {
  using Steady = std::chrono::steady_clock;
  const auto end = Steady::now() + std::chrono::duration<double>{budget_s};
  for (int i = 0; i < kWarmUp; ++i) cycle();
  Growth growth;
  growth.mappings = -mappings();
  growth.heap_bytes = -heap_bytes();
  growth.resident_bytes = -resident_bytes();
  while (growth.cycles < cycles && Steady::now() < end) {
    cycle();
    ++growth.cycles;
  }
  growth.resident_bytes += resident_bytes();
  growth.heap_bytes += heap_bytes();
  growth.mappings += mappings();
  if (kSanitized) growth.resident_bytes = growth.heap_bytes = growth.mappings = 0;
  growth.still_mapped = is_mapped(library);
  return growth;
}

}  // namespace armature
