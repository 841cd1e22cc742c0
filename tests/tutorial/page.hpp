// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace armature::test {

/// The lines between the first ```language of a page and the next ```.
inline std::string block_of(const std::string& page, const std::string& language) {
  const std::string opening = "```" + language + "\n";
  const std::size_t begin = page.find(opening) + opening.size();
  return page.substr(begin, page.find("```", begin) - begin);
}

}  // namespace armature::test
