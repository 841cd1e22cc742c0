// SPDX-License-Identifier: Apache-2.0
// What others wrote need not be UTF-8, for which nlohmann's dump() throws: whatever writes JSON
// calls json_text.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/text.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

TEST(SourceTree, WritesJsonOfOthersThroughOneFunctionThatThrowsForNoByte) {
  int files = 0;
  for (const char* room : {"apps", "framework", "plugins"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator{fs::path{ARMATURE_SOURCE_DIR} / room}) {
      const std::string name = entry.path().filename();
      if (!name.ends_with(".cpp") || name.ends_with("_test.cpp")) continue;
      ++files;
      EXPECT_EQ(text_of(entry.path()).find("dump("), std::string::npos)
          << entry.path() << " calls dump(); json_text(json) of armature/values/json_text.hpp does "
          << "the same of any text";
    }
  }
  EXPECT_GT(files, 100);
}

}  // namespace
}  // namespace armature::test
