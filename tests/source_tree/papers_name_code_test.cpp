// SPDX-License-Identifier: Apache-2.0
// docs/papers/ and the READMEs of the plugins say where an equation is in the code: 1. every file
// that they name is there, 2. every function that they name beside it is in that file.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>

#include "tests/text.hpp"

namespace armature::paper {
namespace {

namespace fs = std::filesystem;

/// Every source file of the tree by its name.
std::multimap<std::string, fs::path> sources() {
  std::multimap<std::string, fs::path> files;
  for (const char* folder : {"apps", "framework", "idl", "plugins", "configs", "tests"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator{fs::path{ARMATURE_SOURCE_DIR} / folder}) {
      if (entry.is_regular_file()) files.emplace(entry.path().filename(), entry.path());
    }
  }
  return files;
}

/// The files that `name`, with or without folders, can mean: those of the page's folder first.
std::vector<fs::path> meant(const std::string& name, const fs::path& page,
                            const std::multimap<std::string, fs::path>& files) {
  std::vector<fs::path> found;
  const auto [first, last] = files.equal_range(fs::path{name}.filename());
  for (auto file = first; file != last; ++file) {
    if (file->second.string().ends_with("/" + name)) found.push_back(file->second);
  }
  const auto beside = [&](const fs::path& file) {
    return file.parent_path() == page.parent_path();
  };
  if (std::ranges::any_of(found, beside)) std::erase_if(found, std::not_fn(beside));
  return found;
}

std::vector<fs::path> pages() {
  std::vector<fs::path> found;
  for (const char* folder : {"docs/papers", "plugins"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator{fs::path{ARMATURE_SOURCE_DIR} / folder}) {
      if (entry.path().extension() == ".md") found.push_back(entry.path());
    }
  }
  return found;
}

class Pages : public testing::Test {
 protected:
  const std::multimap<std::string, fs::path> files_ = sources();
};

TEST_F(Pages, NameFilesThatAreThere) {
  const std::string file = "`([a-z0-9_/]+\\.(cpp|hpp|yaml|urdf|py))[`:]";
  int named = 0;
  for (const fs::path& page : pages()) {
    for (const auto& match : test::matches_of(file, test::text_of(page))) {
      EXPECT_FALSE(meant(match[1], page, files_).empty())
          << page << " names " << match[1] << ", which is nowhere";
      ++named;
    }
  }
  EXPECT_GE(named, 50);
}

TEST_F(Pages, NameFunctionsThatAreInTheirFiles) {
  const std::string place = "`([a-z0-9_/]+\\.(?:cpp|hpp))`: ((?:`[A-Za-z0-9_:]+`(?:, )?)+)";
  const std::string word = "`(?:[A-Za-z0-9_]+::)*([A-Za-z0-9_]+)`";
  int named = 0;
  for (const fs::path& page : pages()) {
    for (const auto& match : test::matches_of(place, test::text_of(page))) {
      for (const auto& name : test::matches_of(word, match[2])) {
        const std::string whole = "\\b" + name[1] + "\\b";
        EXPECT_TRUE(
            std::ranges::any_of(meant(match[1], page, files_),
                                [&](const fs::path& path) {
                                  return !test::matches_of(whole, test::text_of(path)).empty();
                                }))
            << page << ": there is no " << name[1] << " in " << match[1];
        ++named;
      }
    }
  }
  EXPECT_GE(named, 25);
}

}  // namespace
}  // namespace armature::paper
