// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/setup_error.hpp"

#include <exception>
#include <vector>

#include "armature/config/problems.hpp"

namespace armature {

SetupError::~SetupError() = default;
SlotError::~SlotError() = default;

std::string current_exception_text() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "an exception that is no std::exception";
  }
}

namespace {

[[noreturn]] void throw_setup_error(const std::string& what, std::string_view slot) {
  if (!slot.empty()) throw SlotError{std::string{slot}, what};
  throw SetupError{what};
}

}  // namespace

void throw_as_own(const std::string& who, std::string_view slot) {
  try {
    throw;
  } catch (const config::ConfigError& error) {
    throw config::ConfigError{{error.problems().begin(), error.problems().end()}};
  } catch (const SlotError& error) {
    throw SlotError{std::string{error.slot()}, std::string{error.what()}};
  } catch (const SetupError& error) {
    throw_setup_error(std::string{error.what()}, slot);
  } catch (...) {
    throw_setup_error(who + ": " + current_exception_text(), slot);
  }
}

}  // namespace armature
