// SPDX-License-Identifier: Apache-2.0
// `armature doctor` on the machine that the tests run on, whatever that is like.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "armature/values/temporary_folder.hpp"
#include "command.hpp"

namespace armature::test {
namespace {

using testing::HasSubstr;

nlohmann::json about(const std::string& what, const nlohmann::json& told) {
  for (const auto& finding : told.at("findings")) {
    if (finding.at("what") == what) return finding;
  }
  return {};
}

TEST(DoctorCommand, SaysALineForEachFindingAndEndsByItsProblems) {
  const auto as_json = run_command({armature(), "doctor", "--json"});
  const auto told = nlohmann::json::parse(as_json.out);
  EXPECT_EQ(as_json.exit_code, told.at("problems") == 0 ? 0 : 1) << as_json.out;
  const auto text = run_command({armature(), "doctor"});
  EXPECT_EQ(std::count(text.out.begin(), text.out.end(), '\n'), told.at("findings").size());
  std::istringstream lines{text.out};
  for (std::string line; std::getline(lines, line);) {
    EXPECT_THAT(line, testing::MatchesRegex("(ok|warning|problem) +[a-zA-Z].*; .*"));
  }
  EXPECT_EQ(about("plugins", told).at("level"), "ok");
  EXPECT_EQ(about("loopback", told).at("level"), "ok");
}

TEST(DoctorCommand, NamesALibraryThatDoesNotLoadAndTheFolderItIsIn) {
  const TemporaryFolder folder;
  std::ofstream{folder / "broken.so"} << "no library";
  const auto sick =
      run_command({armature(), "doctor"},
                  {.environment = {{"ARMATURE_PLUGIN_PATH", folder.path().string()}}, .input = {}});
  EXPECT_EQ(sick.exit_code, 1);
  EXPECT_THAT(sick.out, HasSubstr("plugin folder          " + folder.path().string()));
  EXPECT_THAT(sick.out, HasSubstr("plugin library         " + (folder / "broken.so").string()));
}

}  // namespace
}  // namespace armature::test
