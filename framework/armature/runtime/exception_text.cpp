// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/exception_text.hpp"

#include <exception>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/runtime/setup.hpp"

namespace armature {

std::string current_exception_text() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (...) {
    return "an exception that is no std::exception";
  }
}

void throw_as_own(const std::string& who) {
  try {
    throw;
  } catch (const config::ConfigError& error) {
    throw config::ConfigError{{error.problems().begin(), error.problems().end()}};
  } catch (const SetupError& error) {
    throw SetupError{std::string{error.what()}};
  } catch (...) {
    throw SetupError{who + ": " + current_exception_text()};
  }
}

}  // namespace armature
