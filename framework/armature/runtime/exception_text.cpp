// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/exception_text.hpp"

#include <exception>

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

}  // namespace armature
