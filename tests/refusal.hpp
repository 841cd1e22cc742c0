// SPDX-License-Identifier: Apache-2.0
// Why something is refused, as a test compares it. An exception of another type than the expected
// one differs by its text.
#pragma once

#include <exception>
#include <string>
#include <vector>

#include "armature/config/problems.hpp"

namespace armature::test {

/// What `work` throws, as text; "" when it throws nothing.
template <class Work>
std::string refusal_of(const Work& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

/// Every problem of the files that `work` reads, with its place; none when it throws nothing.
template <class Work>
std::vector<std::string> problems_of(const Work& work) {
  std::vector<std::string> texts;
  try {
    work();
  } catch (const config::ConfigError& error) {
    for (const auto& problem : error.problems()) texts.push_back(problem.text());
  }
  return texts;
}

}  // namespace armature::test
