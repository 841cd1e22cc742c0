// SPDX-License-Identifier: Apache-2.0
#include "tests/text.hpp"

#include <fstream>
#include <regex>
#include <sstream>

namespace armature::test {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream{file}.rdbuf();
  return text.str();
}

std::vector<std::vector<std::string>> matches_of(const std::string& pattern,
                                                 const std::string& text) {
  const std::regex compiled{pattern};
  std::vector<std::vector<std::string>> all;
  for (std::sregex_iterator at{text.begin(), text.end(), compiled}, end; at != end; ++at) {
    all.emplace_back(at->begin(), at->end());
  }
  return all;
}

std::string all_replaced(const std::string& text, const std::string& pattern,
                         const std::string& by) {
  return std::regex_replace(text, std::regex{pattern}, by);
}

}  // namespace armature::test
