// SPDX-License-Identifier: Apache-2.0
// Where a document names a test as what holds a promise, there is one: `Suite.Name`, `Suite.*`,
// `Suite.Begins*`.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "tests/text.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

/// Adds "TargetLaws.TheSentence" for every law that stands beside `contract`, a kind's laws as
/// tests.
void add_names_of_laws(const fs::path& contract, std::set<std::string>& names) {
  const auto suites = matches_of(R"(class (\w+Laws) : public)", text_of(contract));
  if (suites.empty()) return;
  for (const auto& entry : fs::recursive_directory_iterator{contract.parent_path()}) {
    if (entry.path().extension() != ".hpp") continue;
    for (const auto& law : matches_of(R"(\bLAW\((\w+),)", text_of(entry.path()))) {
      names.insert(suites.front()[1] + "." + law[1]);
    }
  }
}

/// "Suite.Name" of all tests in the sources.
std::set<std::string> names_of_tests() {
  const std::string definition = R"(TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\))";
  std::set<std::string> names;
  for (const char* room : {"framework", "plugins", "apps", "tests"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator{fs::path{ARMATURE_SOURCE_DIR} / room}) {
      if (entry.path().filename() == "contract.hpp") add_names_of_laws(entry.path(), names);
      if (entry.path().extension() != ".cpp") continue;
      for (const auto& test : matches_of(definition, text_of(entry.path()))) {
        names.insert(test[1] + "." + test[2]);
      }
    }
  }
  return names;
}

bool names_a_test(const std::string& name, const std::set<std::string>& tests) {
  if (!name.ends_with('*')) return tests.contains(name);
  const std::string begins = name.substr(0, name.size() - 1);
  const auto first = tests.lower_bound(begins);
  return first != tests.end() && first->starts_with(begins);
}

TEST(NamesOfTests, InDocumentsAreThoseOfTests) {
  const std::set<std::string> tests = names_of_tests();
  const std::string mention = R"(`([A-Z]\w*\.(?:[A-Z]\w*)?\*?)`)";
  for (const char* document : {"docs/safety.md", "docs/guarantees.md"}) {
    const auto mentions = matches_of(mention, text_of(fs::path{ARMATURE_SOURCE_DIR} / document));
    for (const auto& match : mentions) {
      if (match[1] == "Suite.Name") continue;
      EXPECT_TRUE(names_a_test(match[1], tests)) << document << " names " << match[1];
    }
    EXPECT_GT(mentions.size(), 10U) << document;
  }
}

}  // namespace
}  // namespace armature::test
