// SPDX-License-Identifier: Apache-2.0
// `armature reproduce`: the four papers.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "tests/command.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Reproduce : public testing::TestWithParam<const char*> {};

TEST_P(Reproduce, EveryRowHoldsAndEveryFigureIsWritten) {
  const TemporaryFolder folder;
  const auto result = run_command(
      {armature(), "reproduce", GetParam(), "--short", "--json", "--out", folder / "out"});
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  const auto report = nlohmann::json::parse(result.out);
  EXPECT_GT(report["rows"], 20);
  EXPECT_EQ(report["failed"], 0);
  int tables = 0, figures = 0;
  for (const auto& entry : fs::directory_iterator{folder / "out"}) {
    const std::string text = content_of(entry.path());
    if (entry.path().extension() == ".svg") {
      ++figures;
      EXPECT_THAT(text, HasSubstr("class=\"curve\"")) << entry.path();
      EXPECT_TRUE(fs::exists(fs::path{entry.path()}.replace_extension(".csv")));
    } else {
      ++tables;
      EXPECT_TRUE(text.ends_with("\r\n")) << entry.path();
    }
  }
  EXPECT_GE(figures, 4);
  EXPECT_EQ(tables, figures + static_cast<int>(report["tables"].size()));
}

INSTANTIATE_TEST_SUITE_P(Papers, Reproduce, testing::Values("lamp", "sr1", "implant", "master"),
                         [](const auto& of) { return std::string{of.param}; });

TEST(ReproduceCommand, NamesThePapersWhereThereIsNoSuchOne) {
  const auto result = run_command({armature(), "reproduce", "lmap"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("no paper 'lmap'; did you mean 'lamp'?"));
}

TEST(ReproduceCommand, ShowsWhatThePaperPrintsBesideOursAndItsMisprints) {
  const auto result = run_command({armature(), "reproduce", "lamp", "--short"});
  EXPECT_THAT(result.out, testing::ContainsRegex("P2.x +446.8 +1446.78.+misprint: leading 1 lost"));
  EXPECT_THAT(result.out, HasSubstr("0 fail; 11 misprints named, 0 differ"));
}

}  // namespace
}  // namespace armature::test
