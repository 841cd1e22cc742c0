// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace armature ARMATURE_EXPORT {

/// A component cannot be set up: what is wrong and the way out. The runtime adds the place.
class [[gnu::visibility("default")]] SetupError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~SetupError() override;  // one type in every library that throws or catches it
};

/// The plugin in a slot cannot be made; the runtime adds where the slot stands in the file.
class [[gnu::visibility("default")]] SlotError : public SetupError {
 public:
  SlotError(std::string slot, const std::string& what) : SetupError{what}, slot_{std::move(slot)} {}
  ~SlotError() override;
  const std::string& slot() const { return slot_; }

 private:
  std::string slot_;
};

/// What the exception says that is being handled; of foreign code, which may throw anything.
std::string current_exception_text();

/// Throws what is being handled as an exception of this library: a ConfigError or a SetupError as
/// it is, anything else as a SetupError that begins with `who`; of a plugin in `slot` it is a
/// SlotError. An exception whose type a plugin defines must not outlive the plugin's library, which
/// holds the code that destroys it.
[[noreturn]] void throw_as_own(const std::string& who, std::string_view slot = {});

}  // namespace armature
