// SPDX-License-Identifier: Apache-2.0
// A newcomer follows the pages one after the other in one folder.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "tests/text.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

TEST(PagesForNewcomers, WritePluginsToFoldersOfTheirOwn) {
  std::map<std::string, std::string> pages;  // by the folder that each writes
  for (const fs::path folder : {ARMATURE_SOURCE_DIR, ARMATURE_SOURCE_DIR "/docs"}) {
    for (const auto& page : fs::directory_iterator{folder}) {
      if (page.path().extension() != ".md") continue;
      for (const auto& command : matches_of("\\n\\$ (?:tools/)?armature plugin new \\S+ -o (\\S+)",
                                            text_of(page.path()))) {
        const auto [first, is_new] = pages.emplace(command[1], page.path().filename());
        EXPECT_TRUE(is_new) << page.path().filename() << " writes '" << command[1] << "', as does "
                            << first->second;
      }
    }
  }
  EXPECT_GE(pages.size(), 4U);
}

}  // namespace
}  // namespace armature::test
