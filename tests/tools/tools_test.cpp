// SPDX-License-Identifier: Apache-2.0
// tools/: what is installed and why, how far a build is, and the verdict of the tests. Nothing is
// installed, built or tested here: apt-get, cmake, ninja and ctest are replaced by stand-ins.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "command.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

/// A tree with the scripts, in which `ninja` and others are what a test wants them to be.
class Tools : public testing::Test {
 protected:
  Tools() {
    fs::create_directories(root_ / "stand_ins");
    fs::copy(source_file("tools"), root_ / "tools", fs::copy_options::recursive);
    stand_in("sudo", "exec \"$@\"");
    stand_in("dpkg-query", "shift 3; for package; do echo \"installed $package\"; done");
    stand_in("nproc", "echo 2");
    stand_in("apt-get", "echo 'apt-get was called' >&2; exit 1");
  }

  void stand_in(const std::string& name, const std::string& script) const {
    const fs::path file = root_ / "stand_ins" / name;
    std::ofstream{file} << "#!/bin/bash\n" << script << "\n";
    fs::permissions(file, fs::perms::owner_all);
  }
  /// A build folder that has been configured.
  void configured(const std::string& preset) const {
    fs::create_directories(root_ / "build" / preset);
    std::ofstream{root_ / "CMakePresets.json"} << "{}";
    std::ofstream{root_ / "build" / preset / "build.ninja"} << "\n";
    fs::last_write_time(root_ / "CMakePresets.json",
                        fs::last_write_time(root_ / "build" / preset / "build.ninja"));
  }
  CommandResult run(std::vector<std::string> arguments) const {
    arguments.front() = root_ / "tools" / arguments.front();
    const char* path = std::getenv("PATH");
    return run_command(
        arguments,
        {.environment = {{"PATH", (root_ / "stand_ins").string() + ":" + (path ? path : "")},
                         {"TMPDIR", root_.path().string()}},
         .input = {}});
  }

  const TemporaryFolder root_;
};

std::string last_line(const std::string& text) {
  const std::string lines = text.substr(0, text.find_last_not_of('\n') + 1);
  return lines.substr(lines.rfind('\n') + 1);
}

std::ptrdiff_t count_lines(const std::string& text) { return std::ranges::count(text, '\n'); }

using EnsurePackages = Tools;

TEST_F(EnsurePackages, SaysNothingWhenAllIsThere) {
  const auto result = run({"ensure-packages"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

constexpr const char* kNinjaIsMissing =
    "shift 3; for package; do [ $package = ninja-build ] || echo \"installed $package\"; done";

TEST_F(EnsurePackages, SaysWhatWillBeInstalledWhatForAndHowLargeItIs) {
  stand_in("dpkg-query", kNinjaIsMissing);
  stand_in("apt-get", R"(case "$*" in
*update*) ;;
*--print-uris*) echo "1 upgraded, 2 newly installed, 0 to remove and 7 not upgraded."
  echo "Need to get 210 kB of archives."
  echo "After this operation, 900 kB of additional disk space will be used." ;;
*"--no-install-recommends ninja-build") echo "Setting up ninja-build (1.11.1) ..." ;;
*) exit 1 ;;
esac)");
  const auto result = run({"ensure-packages"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("\n  ninja-build              builds it\n"));
  EXPECT_THAT(result.err, HasSubstr("3 packages with what they need themselves: 210 kB to "
                                    "download, 900 kB on disk\n"));
  EXPECT_THAT(result.err, Not(HasSubstr("Setting up"))) << "of what succeeds the result is told";
  EXPECT_THAT(last_line(result.err), testing::StartsWith("armature: installed 1 packages in "));
}

TEST_F(EnsurePackages, ShowsWhyAnInstallationFailed) {
  stand_in("dpkg-query", kNinjaIsMissing);
  stand_in("apt-get",
           "[[ $* != *--print-uris* ]] || exit 0\n"
           "[[ $* != *install* ]] || { echo 'E: no space left'; exit 100; }");
  const auto result = run({"ensure-packages"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("\nE: no space left\n"));
}

TEST_F(EnsurePackages, ThatIsTheSecondWaitsForTheFirstAndInstallsNothingAgain) {
  const std::string there = root_ / "there";
  stand_in("dpkg-query", "shift 3; for package; do [ $package = ninja-build -a ! -e '" + there +
                             "' ] || echo \"installed $package\"; done");
  stand_in("apt-get", "case \"$*\" in *update* | *--print-uris*) ;; *) mkdir '" + there +
                          ".now' || exit 1; sleep 1; touch '" + there + "' ;; esac");
  const auto both = run_command({"/bin/bash", "-c",
                                 "PATH=\"$0/stand_ins:$PATH\"; \"$0/tools/ensure-packages\" & "
                                 "\"$0/tools/ensure-packages\" && wait $!",
                                 root_.path().string()});
  EXPECT_EQ(both.exit_code, 0) << both.err;
  EXPECT_THAT(both.err, HasSubstr("armature: waits for another one that installs packages\n"));
  EXPECT_TRUE(fs::exists(there));
}

TEST_F(EnsurePackages, LeavesASystemAloneThatHasOtherPackages) {
  stand_in("dirname", "exec /usr/bin/dirname \"$@\"");
  stand_in("readlink", "exec /usr/bin/readlink \"$@\"");
  fs::remove(root_ / "stand_ins/dpkg-query");
  const auto result = run_command({"/bin/bash", root_ / "tools/ensure-packages"},
                                  {.environment = {{"PATH", root_ / "stand_ins"}}, .input = {}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("armature: there is no dpkg here: "));
}

TEST_F(EnsurePackages, OfEveryPackageSaysWhatItIsFor) {
  std::ifstream list{root_ / "tools/apt-packages.txt"};
  for (std::string line; std::getline(list, line);) {
    if (line.empty() || line.front() == '#') continue;
    EXPECT_THAT(line, testing::MatchesRegex("[a-z0-9.+-]+ +# .+"));
  }
}

using Build = Tools;

TEST_F(Build, SaysNothingWhenNothingHasChanged) {
  configured("release");
  stand_in("ninja", "echo 'ninja: no work to do.'");
  stand_in("cmake", "echo 'configured again' >&2; exit 1");
  const auto result = run({"build", "release", "deployable"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(Build, OfATreeThatCannotBeWrittenNamesWhatIsBuilt) {
  fs::create_directories(root_ / "build/release.lock");
  const auto result = run({"build", "release"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("build/ is not yours to write; what is built there runs as "
                                    "build/release/bin/armature\n"));
}

TEST_F(Build, TellsALogEveryTenthPartAndNotEveryStep) {
  configured("release");
  stand_in("ninja",
           "for step in {1..200}; do echo \"${NINJA_STATUS//@%f\\/%t/@$step/200}Building\"; done");
  const auto result = run({"build", "release"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(count_lines(result.err), 11) << result.err;
  EXPECT_THAT(result.err, testing::StartsWith("armature: building: 0 %, 1 of 200 steps\n"));
  EXPECT_EQ(last_line(result.err).substr(0, 43), "armature: building: 100 %, 200 of 200 steps");
}

TEST_F(Build, ShowsTheErrorOfTheCompilerAndNoneOfTheStepsThatSucceeded) {
  configured("release");
  stand_in("ninja",
           "echo '@1/2 Building a.o'; echo 'FAILED: b.o'\n"
           "echo 'b.cpp:1:1: error: a word is missing'; exit 1");
  const auto result = run({"build", "release"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err,
              HasSubstr("\nFAILED: b.o\nb.cpp:1:1: error: a word is missing\narmature: "));
  EXPECT_THAT(result.err, Not(HasSubstr("a.o")));
}

TEST_F(Build, ConfiguresAtFirstAndShowsAllOfItWhenThatFails) {
  stand_in("cmake", "echo '-- found the compiler'; echo 'CMake Error: no Eigen' >&2; exit 1");
  const auto result = run({"build", "release"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_EQ(result.err,
            "armature: configuring build/release\n"
            "CMake Error: no Eigen\n-- found the compiler\n");
}

TEST_F(Build, ThatIsTheSecondInAFolderWaitsForTheFirst) {
  configured("release");
  const std::string builds = root_ / "builds";
  stand_in("ninja", "mkdir '" + builds + "' || exit 1; sleep 1; rmdir '" + builds + "'");
  const auto both = run_command({"/bin/bash", "-c",
                                 "PATH=\"$0/stand_ins:$PATH\"; \"$0/tools/build\" release & "
                                 "\"$0/tools/build\" release && wait $!",
                                 root_.path().string()});
  EXPECT_EQ(both.exit_code, 0) << both.err;
  EXPECT_THAT(both.err,
              HasSubstr("armature: waits for another one that builds in build/release\n"));
}

using Armature = Tools;

TEST_F(Armature, StopsCommandsAndWatchesWithWhatIsBuiltThoughTheSourcesAreBroken) {
  configured("release");
  stand_in("ninja", "echo 'a.cpp:1:1: error: a word is missing'; exit 1");
  const fs::path program = root_ / "build/release/bin/armature";
  fs::create_directories(program.parent_path());
  std::ofstream{program} << "#!/bin/bash\necho \"told: $*\"\n";
  fs::permissions(program, fs::perms::owner_all);
  for (const char* verb : {"stop", "operator", "topic", "top", "log", "monitor", "record"}) {
    const auto result = run({"armature", verb, "--domain", "3"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, std::string{"told: "} + verb + " --domain 3\n");
  }
  EXPECT_EQ(run({"armature", "run", "a.yaml"}).exit_code, 1) << "a run is one of the sources";
}

TEST_F(Armature, BuildsForAStopWhenNothingIsBuilt) {
  configured("release");
  stand_in(
      "ninja",
      "mkdir -p bin; printf '#!/bin/bash\\necho stopped\\n' > bin/armature; chmod +x bin/armature");
  const auto result = run({"armature", "stop"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "stopped\n");
}

using Results = Tools;

TEST_F(Results, LeaveThePageAloneWhenASweepDidNotEndAsOne) {
  const fs::path page = root_ / "docs/results.md";
  fs::create_directories(page.parent_path());
  std::ofstream{page} << "the last ones\n";
  std::ofstream{root_ / "tools/armature"}
      << "#!/bin/bash\necho 'sr1_biopsy: 1000 runs'\n[ $2 != sr1_biopsy ] || exit 3\n";
  const auto result = run({"results"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("the sweep of sr1_biopsy ended with exit code 3"));
  EXPECT_EQ(content_of(page), "the last ones\n");
}

/// What ctest prints of three tests, of which the second `ended`.
std::string ctest_of(const std::string& ended, int exit_code) {
  return R"(cat <<'END'
Internal ctest changing into directory: /x
Test project /x
      Start 1: a_test.A.IsSound
1/3 Test #1: a_test.A.IsSound ............   Passed    0.01 sec
      Start 2: a_test.A.Is['odd']/x  # GetParam() = x
2/3 Test #2: a_test.A.Is['odd']/x  # GetParam() = x ...***)" +
         ended + R"(    0.02 sec
Expected: 1, actual: 2
      Start 3: a_test.A.DoesNotApply
3/3 Test #3: a_test.A.DoesNotApply .......***Skipped   0.00 sec

66% tests passed, 1 tests failed out of 3

Total Test time (real) =   0.03 sec

The following tests did not run:
	  3 - a_test.A.DoesNotApply (Skipped)
END
exit )" + std::to_string(exit_code);
}

using RunTests = Tools;

TEST_F(RunTests, EndsWithTheVerdictAndNotWithAListOfWhatDidNotApply) {
  stand_in("ctest", ctest_of("Skipped ", 0));
  const auto result = run({"run-tests", "release"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(last_line(result.out), testing::MatchesRegex("1 of 1 passed in [0-9]+ s, 2 skipped"));
  EXPECT_THAT(result.out, Not(HasSubstr("did not run")));
}

TEST_F(RunTests, NamesWhatFailedShowsWhyAndHowToRunOneAgain) {
  stand_in("ctest", ctest_of("Failed  ", 8));
  const auto result = run({"run-tests", "asan"});
  EXPECT_EQ(result.exit_code, 8) << "that of ctest";
  EXPECT_THAT(result.out, testing::StartsWith("FAILED (Failed): a_test.A.Is['odd']/x\n"
                                              "Expected: 1, actual: 2\n"));
  EXPECT_THAT(result.out,
              testing::ContainsRegex("\n1 of 2 FAILED in [0-9]+ s:\n  a_test.A.Is\\['odd'\\]/x\n"));
  EXPECT_EQ(last_line(result.out),
            R"(One again: tools/test --preset asan --only 'a_test.A.Is['\''odd'\'']/x')");
}

TEST_F(RunTests, SaysWhatToDoWhenTheMachineWasTooBusy) {
  stand_in("ctest", ctest_of("Timeout ", 8));
  const auto result = run({"run-tests", "release"});
  EXPECT_EQ(result.exit_code, 8);
  EXPECT_THAT(result.out, HasSubstr("\n1 of them ran out of time.\nThe load of this machine was "));
  EXPECT_THAT(result.out, HasSubstr("then 'tools/test --again'.\n"));
}

TEST_F(RunTests, DoesNotCallItPassedWhenTheyDidNotAllRun) {
  stand_in("ctest", "echo '1/3 Test #1: a_test.A.IsSound ...   Passed    0.01 sec'; exit 2");
  const auto result = run({"run-tests", "release"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "NOT FINISHED: 1 of 3 tests ran\n");
}

using TestScript = Tools;

TEST_F(TestScript, TakesATestByItsNameWithoutReadingItAsAPattern) {
  configured("dev");
  stand_in("ninja", "exit 0");
  stand_in("ctest", "printf '%s\\n' \"$@\" > \"$(dirname \"$0\")/asked\"");
  EXPECT_EQ(run({"test", "--preset", "dev", "--only", "A.Is(odd)/x[1]"}).exit_code, 0);
  EXPECT_THAT(content_of(root_ / "stand_ins/asked"), HasSubstr("\n-R\nA\\.Is\\(odd\\)/x\\[1\\]\n"));
}

TEST_F(TestScript, RunsNoTestOfWhatCouldNotBeBuilt) {
  configured("release");
  stand_in("ninja", "exit 1");
  stand_in("ctest", "echo tested");
  const auto result = run({"test"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.out, "");
}

TEST_F(TestScript, WhatItDoesNotUnderstandIsAnsweredWithItsUsage) {
  const auto result = run({"test", "--onyl", "x"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, testing::StartsWith("usage: tools/test "));
}

}  // namespace
}  // namespace armature::test
