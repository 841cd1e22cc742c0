// SPDX-License-Identifier: Apache-2.0
// Where a document names a test as what holds a promise, there is one: `Suite.Name`, `Suite.*`,
// `Suite.Begins*`.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>

#include "../text_of.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

/// Adds "TargetLaws.TheSentence" for every law that stands beside `contract`, a kind's laws as
/// tests.
void add_names_of_laws(const fs::path& contract, std::set<std::string>& names) {
  const std::regex suite{R"(class (\w+Laws) : public)"}, law{R"(\bLAW\((\w+),)"};
  const std::string glue = text_of(contract);
  std::smatch found;
  if (!std::regex_search(glue, found, suite)) return;
  for (const auto& entry : fs::recursive_directory_iterator{contract.parent_path()}) {
    if (entry.path().extension() != ".hpp") continue;
    const std::string table = text_of(entry.path());
    for (std::sregex_iterator match{table.begin(), table.end(), law}, end; match != end; ++match) {
      names.insert(found[1].str() + "." + (*match)[1].str());
    }
  }
}

/// "Suite.Name" of all tests in the sources.
std::set<std::string> names_of_tests() {
  const std::regex definition{R"(TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\))"};
  std::set<std::string> names;
  for (const char* room : {"framework", "plugins", "apps", "tests"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator{fs::path{ARMATURE_SOURCE_DIR} / room}) {
      if (entry.path().filename() == "contract.hpp") add_names_of_laws(entry.path(), names);
      if (entry.path().extension() != ".cpp") continue;
      const std::string text = text_of(entry.path());
      for (std::sregex_iterator match{text.begin(), text.end(), definition}, end; match != end;
           ++match) {
        names.insert((*match)[1].str() + "." + (*match)[2].str());
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
  const std::regex mention{R"(`([A-Z]\w*\.(?:[A-Z]\w*)?\*?)`)"};
  for (const char* document : {"docs/safety.md", "docs/guarantees.md"}) {
    const std::string text = text_of(fs::path{ARMATURE_SOURCE_DIR} / document);
    int mentions = 0;
    for (std::sregex_iterator match{text.begin(), text.end(), mention}, end; match != end;
         ++match, ++mentions) {
      const std::string name = (*match)[1];
      if (name == "Suite.Name") continue;
      EXPECT_TRUE(names_a_test(name, tests)) << document << " names " << name;
    }
    EXPECT_GT(mentions, 10) << document;
  }
}

}  // namespace
}  // namespace armature::test
