// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/setup_error.hpp"

#include <cxxabi.h>
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <memory>
#include <typeinfo>

#include "armature/config/problems.hpp"

namespace armature {

SetupError::~SetupError() = default;
SlotError::~SlotError() = default;

namespace {

/// "std::runtime_error".
std::string type_of(const std::exception& error) {
  const char* name = typeid(error).name();
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> readable{
      abi::__cxa_demangle(name, nullptr, nullptr, &status), std::free};
  return readable ? readable.get() : name;
}

}  // namespace

std::string current_exception_text() {
  try {
    throw;
  } catch (const std::exception& error) {
    const std::string text = error.what();
    return text.empty() ? fmt::format("an exception without a text, {}", type_of(error)) : text;
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
