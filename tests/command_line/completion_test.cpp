// SPDX-License-Identifier: Apache-2.0
// What a shell completes, asked of bash itself; and the manual page.
#include <gmock/gmock.h>

#include <sstream>

#include "command.hpp"

namespace armature::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::StartsWith;

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream{text};
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// What bash has after Tab, where it has broken the line into `words` (bash's own syntax).
std::vector<std::string> after_tab(const std::string& words) {
  const std::string script = "source <(" + armature() + " completion bash)\ncd " + source_file("") +
                             "\nCOMP_WORDS=(armature " + words +
                             ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_armature " + armature() +
                             "\nprintf '%s\\n' \"${COMPREPLY[@]}\"";
  const auto result = run_command({"/bin/bash", "-u", "-c", script});
  EXPECT_EQ(result.err, "");
  return lines_of(result.out);
}

TEST(Completion, BashCompletesVerbsAndOptions) {
  EXPECT_THAT(after_tab("dri"), ElementsAre("drill"));
  EXPECT_THAT(after_tab("plugin ''"), IsSupersetOf({"list", "info", "new", "verify"}));
  EXPECT_THAT(after_tab("run --keep"), ElementsAre("--keep-running"));
  EXPECT_THAT(after_tab("completion ''"), ElementsAre("bash", "zsh", "fish"));
}

TEST(Completion, BashCompletesDeploymentsByNameAndByFile) {
  EXPECT_THAT(after_tab("run sr1_b"), ElementsAre("sr1_biopsy"));
  EXPECT_THAT(after_tab("run configs/sr1_b"), ElementsAre("configs/sr1_biopsy.yaml"));
  EXPECT_THAT(after_tab("run conf"), ElementsAre("configs/"));
}

TEST(Completion, BashCompletesPluginIds) {
  EXPECT_THAT(after_tab("plugin info ik/nu"), ElementsAre("ik/numeric"));
  EXPECT_THAT(after_tab("bench ik --plugins ik/kdl,ik/nu"), ElementsAre("ik/kdl,ik/numeric"));
  EXPECT_THAT(after_tab("plugin new ca"), ElementsAre("camera/"));
}

TEST(Completion, BashCompletesAssignmentsOfTheDeploymentThatWasNamed) {
  EXPECT_THAT(after_tab("run dental_lamp --set comp"), ElementsAre("components."));
  EXPECT_THAT(after_tab("run dental_lamp --set components.mot"), ElementsAre("components.motion."));
  EXPECT_THAT(after_tab("run dental_lamp --set components.scene.params.tilt_u"),
              ElementsAre("components.scene.params.tilt_up_deg="));
  EXPECT_THAT(after_tab("run dental_lamp --set components.motion.params.max_jerk_rad"),
              ElementsAre("components.motion.params.max_jerk_rad_s3="));
  // bash breaks the word at '='.
  EXPECT_THAT(after_tab("run dental_lamp --set components.motion.ik.plugin = ik/nu"),
              ElementsAre("ik/numeric"));
  EXPECT_THAT(after_tab("run dental_lamp --set components.motion.ik.plugin ="),
              Contains("ik/numeric"));
}

TEST(Completion, BashCompletesTheHomeOfARobotThatSaysItsFileInAMap) {
  EXPECT_THAT(after_tab("run configs/experiments/lamp_section_5.yaml --set robots.arm."),
              ElementsAre("robots.arm.file=", "robots.arm.home_deg="));
}

TEST(Completion, AsksAWrongFileForNothing) {
  const auto asked = run_command({armature(), "__complete", "run", "nonsense", "--set", "comp"});
  EXPECT_EQ(asked.exit_code, 0);
  EXPECT_EQ(asked.out + asked.err, "");
}

TEST(Completion, IsThereForThreeShellsAndNoOther) {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    EXPECT_THAT(run_command({armature(), "completion", shell}).out, HasSubstr("__complete"));
  }
  EXPECT_EQ(run_command({armature(), "completion", "tcsh"}).exit_code, 2);
}

/// Every line that is a request is one of those that the page is made of.
TEST(TheManualPage, HasEveryVerbAndOnlyKnownRequests) {
  const std::string page = run_command({armature(), "man"}).out;
  EXPECT_THAT(page, StartsWith(".TH ARMATURE 1 "));
  for (const char* verb : {"run", "plugin verify", "topic hz", "doctor", "calibrate hand\\-eye"}) {
    EXPECT_THAT(page, HasSubstr(".SS \"armature " + std::string{verb} + "\"\n"));
  }
  for (const std::string& line : lines_of(page)) {
    if (!line.starts_with('.')) continue;
    EXPECT_THAT(line, testing::MatchesRegex("\\.(TH|SH|SS|B) .+|\\.(TP|PP|nh|ad l)"));
  }
  const auto check = run_command({"/bin/bash", "-c",
                                  "! command -v groff > /dev/null || groff -man "
                                  "-ww -z <(" +
                                      armature() + " man)"});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_EQ(check.err, "");
}

}  // namespace
}  // namespace armature::test
