// SPDX-License-Identifier: Apache-2.0
// An entry of `robots:` with a home of its own: 1. it takes the place of that of the file, 2. what
// is wrong with it is told where it stands.
#include <gmock/gmock.h>

#include "judged_by_schema.hpp"

namespace armature::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kLampRobot = "file: " + source_file("configs/robots/dental_lamp.yaml");

class RobotHome : public JudgedBySchema {
 protected:
  /// What `verb` says of the lamp with `robot` under `robots: {arm: ..}`.
  CommandResult ask(const std::string& verb, const std::string& robot) const {
    const std::string overlay = written("include: " + source_file("configs/dental_lamp.yaml") +
                                        "\nrobots: {arm: " + robot + "}\n");
    std::vector<std::string> words{armature(), verb, overlay};
    if (verb == "show") words.emplace_back("--json");
    return run_command(words);
  }
};

TEST_F(RobotHome, TakesThePlaceOfThatOfTheFile) {
  const std::string robot = "{" + kLampRobot + ", home_deg: [50, -110, 10, -10, 140, 5]}";
  EXPECT_EQ(ask("check", robot).exit_code, 0) << ask("check", robot).err;
  const json shown = json::parse(ask("show", robot).out)["robots"]["arm"];
  EXPECT_EQ(shown["home_deg"][1]["value"], -110);
  EXPECT_EQ(shown["file"]["value"], source_file("configs/robots/dental_lamp.yaml"));
  EXPECT_EQ(judged_text("robots: {arm: " + robot + "}\n"), "");
}

TEST_F(RobotHome, MayBeInRadiansAsInTheFile) {
  EXPECT_EQ(ask("check", "{" + kLampRobot + ", home: [1, -2, 0, 0, 2, 0]}").exit_code, 0);
}

TEST_F(RobotHome, OutOfTheLimitsIsRefusedWhereItStandsWithTheLimits) {
  const auto result = ask("check", "{" + kLampRobot + ", home_deg: [60, -190, 0, 0, 150, 0]}");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, testing::MatchesRegex(".*file_0\\.yaml:2:[0-9]+: 'home_deg': j2 = -190 "
                                                "deg is outside of -160 deg to 160 deg\n"));
}

TEST_F(RobotHome, WithoutAFileTwiceOrWithAKeyThatIsNoneIsRefused) {
  EXPECT_THAT(ask("check", "{home_deg: [60, -110, 0, 0, 150, 0]}").err,
              HasSubstr("missing key 'file' in robot 'arm'"));
  EXPECT_THAT(ask("check", "{" + kLampRobot + ", home_dge: [60]}").err,
              HasSubstr("unknown key 'home_dge' in robot 'arm'; did you mean 'home_deg'?"));
  EXPECT_THAT(ask("check", "{" + kLampRobot + ", home_deg: [60, -110]}").err,
              HasSubstr("'home_deg' needs a value for each of the 6 joints, not 2"));
  EXPECT_THAT(
      ask("check", "{" + kLampRobot + ", home_deg: [0, 0, 0, 0, 0, 0], home: [0, 0, 0, 0, 0, 0]}")
          .err,
      HasSubstr("'home'"));
  expect_refused({{"armature: 1\nname: x\nrobots: {arm: {file: a.yaml, joints: []}}\n", "joints"}});
}

}  // namespace
}  // namespace armature::test
