// SPDX-License-Identifier: Apache-2.0
// The page of `armature monitor`. What is asserted of it in a browser stands in
// apps/monitor/tests/scenarios.mjs; each scenario runs here in a DDS domain of its own.
#include <gtest/gtest.h>

#include <filesystem>

#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

constexpr int kSkipped = 77;  // of the scripts, which print why
constexpr std::chrono::seconds kPatience{400};

/// A script beside the page's sources.
CommandResult run_script(const std::string& name) {
  return run_command({source_file("apps/monitor/tests/" + name), PAGE_BUILD}, {}, kPatience);
}

TEST(Page, IsWhatItsSourcesGive) {
  const CommandResult result = run_script("rebuild");
  if (result.exit_code == kSkipped) GTEST_SKIP() << result.out;
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

TEST(Page, KeepsTheLawsOfItsPartsThatNeedNoBrowser) {
  const CommandResult prepared = run_script("prepare");
  if (prepared.exit_code == kSkipped) GTEST_SKIP() << prepared.out;
  const CommandResult result = run_script("unit");
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
}

class PageInABrowser : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists("/usr/bin/chromium")) {
      GTEST_SKIP() << "skipped: there is no browser (apt-get install --no-install-recommends "
                      "chromium)";
    }
    const CommandResult prepared = run_script("prepare");
    if (prepared.exit_code == kSkipped) GTEST_SKIP() << prepared.out;
    ASSERT_EQ(prepared.exit_code, 0) << prepared.out << prepared.err;
  }
  static void expect_true(const std::string& scenario) {
    const CommandResult result =
        run_command({"/usr/bin/env", "node", PAGE_BUILD "/page/tests/browser.mjs", scenario,
                     std::to_string(unique_dds_domain())},
                    {.environment = {{"ARMATURE", armature()}}}, kPatience);
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    RecordProperty("told", result.out);
  }
};

TEST_F(PageInABrowser, DrawsTheArmWhereForwardKinematicsHasIt) { expect_true("arm"); }
TEST_F(PageInABrowser, ShowsBothPicturesAsJpegWithTheirLandmarks) { expect_true("pictures"); }
TEST_F(PageInABrowser, HasAPointForEveryMessageAndGoalsOfTheFile) { expect_true("plots"); }
TEST_F(PageInABrowser, ShowsEveryComponentAsItsStateIsTold) { expect_true("graph"); }
TEST_F(PageInABrowser, ShowsWhatWasWhenItIsPausedAndGoneBack) { expect_true("scrub"); }
TEST_F(PageInABrowser, ComesBackAfterALostConnectionAndFollowsANewRun) { expect_true("again"); }
TEST_F(PageInABrowser, OpensARecordingWholeOrCutOff) { expect_true("recording"); }
TEST_F(PageInABrowser, PlaysPausesAndSeeksInARecordingOfAServer) { expect_true("playback"); }
TEST_F(PageInABrowser, OpensAReportOfARunFromTheDisk) { expect_true("report"); }
TEST_F(PageInABrowser, OpensThePageThatARunWritesIntoItsReport) { expect_true("ownReport"); }
TEST_F(PageInABrowser, LetsChooseBetweenTwoDeployments) { expect_true("two"); }
TEST_F(PageInABrowser, SurvivesMessagesThatMakeNoSense) { expect_true("nonsense"); }
TEST_F(PageInABrowser, FitsLaptopAndTabletAndIsUsedByKeyboard) { expect_true("sizes"); }
TEST_F(PageInABrowser, HasFirstDataWithinTwoSeconds) { expect_true("figures"); }

/// No browser is needed for these, but the packages are.
class OtherClients : public PageInABrowser {};

TEST_F(OtherClients, DecodeEveryMessageOfALiveDeployment) { expect_true("clients"); }
TEST_F(OtherClients, AreNotSlowedByTenThatReadNothing) { expect_true("lazy"); }

}  // namespace
}  // namespace armature::test
