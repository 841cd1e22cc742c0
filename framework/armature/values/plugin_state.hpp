// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <string_view>
#include <type_traits>

namespace armature ARMATURE_EXPORT {

/// The number of a layout: the plugin's name and the version of what it remembers. A plugin counts
/// the version up whenever the struct changes.
constexpr std::uint64_t layout_id(std::string_view plugin, std::uint64_t version) {
  std::uint64_t hash = 14695981039346656037u ^ version;  // FNV-1a
  for (const char c : plugin) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return hash | 1;  // never 0, which is "nothing"
}

/// What a plugin remembers between two calls. The caller owns it and does not look into it; a new
/// one remembers nothing. It is plain bytes: it can be copied, kept and handed to another instance
/// of the same plugin, and it outlives the plugin's library. What was remembered in another layout
/// counts as nothing. Real-time safe: never allocates.
///
///     struct Memory {
///       static constexpr auto kLayout = layout_id("target/mine", 1);
///       double mean[3];
///     };
///     const Memory* memory = state.get<Memory>();
///
/// where nullptr says that nothing is remembered.
class PluginState {
 public:
  static constexpr std::size_t kCapacity = 2048;  // [bytes]

  bool empty() const { return layout_ == 0; }

  template <class Memory>
  const Memory* get() const {
    check<Memory>();
    return layout_ == Memory::kLayout ? std::launder(reinterpret_cast<const Memory*>(bytes_.data()))
                                      : nullptr;
  }

  template <class Memory>
  void set(const Memory& memory) {
    check<Memory>();
    layout_ = Memory::kLayout;
    ::new (bytes_.data()) Memory(memory);
  }

 private:
  template <class Memory>
  static constexpr void check() {
    static_assert(std::is_trivially_copyable_v<Memory>, "its bytes are copied");
    static_assert(sizeof(Memory) <= kCapacity && alignof(Memory) <= alignof(std::max_align_t));
  }

  std::uint64_t layout_ = 0;
  alignas(std::max_align_t) std::array<std::byte, kCapacity> bytes_{};
};

}  // namespace armature
