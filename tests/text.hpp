// SPDX-License-Identifier: Apache-2.0
// What tests read of files and outputs. Patterns are those of ECMAScript; std::regex takes
// long to compile, and does so in text.cpp only.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace armature::test {

/// The whole of a file; "" when it cannot be read.
std::string text_of(const std::filesystem::path& file);
/// Every match of the pattern, from the first on: the whole match, then its groups.
std::vector<std::vector<std::string>> matches_of(const std::string& pattern,
                                                 const std::string& text);
/// The text with every match replaced; "$1" in `by` is the first group.
std::string all_replaced(const std::string& text, const std::string& pattern,
                         const std::string& by);

}  // namespace armature::test
