// SPDX-License-Identifier: Apache-2.0
// `armature run` for a script: one JSON object whatever happens, and every file or a reason.
#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;

class RunForAScript : public testing::Test {
 protected:
  /// The biopsy, on the simulated clock.
  CommandResult run(const std::vector<std::string>& more) const {
    std::vector<std::string> command{armature(), "run",      source_file("configs/sr1_biopsy.yaml"),
                                     "--json",   "--domain", std::to_string(domain_)};
    command.insert(command.end(), more.begin(), more.end());
    return run_command(command);
  }

  /// An older report in the folder; and what is there now.
  void leave_report() const { std::ofstream{folder_ / "report.json"} << "{\"status\":\"ok\"}\n"; }
  std::string report() const { return content_of(folder_ / "report.json"); }

  const TemporaryFolder folder_;
  const int domain_ = unique_dds_domain();
};

TEST_F(RunForAScript, AFaultyDeploymentIsOneObjectToo) {
  const auto result = run({"--set", "components.motion.ik.plugin=ik/numerc"});
  EXPECT_EQ(result.exit_code, 3);
  const auto told = nlohmann::json::parse(result.out);
  EXPECT_EQ(told["status"], "invalid_config");
  EXPECT_EQ(told["reason"].get<std::string>() + "\n", result.err);
}

TEST_F(RunForAScript, ANameThatIsNoFileIsOneObjectToo) {
  const auto result = run_command({armature(), "run", "nosuch", "--json"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(nlohmann::json::parse(result.out)["status"], "invalid_config");
}

TEST_F(RunForAScript, CountsTheComponentsThatItsFileHas) {
  EXPECT_THAT(run({"--report", folder_.path()}).err,
              testing::HasSubstr("starting sr1_biopsy: 7 components\n"));
}

TEST_F(RunForAScript, OfARunThatIsRefusedTheReportIsWhatIsPrinted) {
  leave_report();
  const auto unknown =
      run({"--report", folder_.path(), "--set", "components.motion.ik.plugin=ik/numerc"});
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_EQ(nlohmann::json::parse(report())["status"], "invalid_config");
  EXPECT_EQ(report(), unknown.out);
}

TEST_F(RunForAScript, AReportFolderThatCannotBeMadeIsToldBeforeTheRun) {
  const fs::path file = folder_ / "file";
  std::ofstream{file} << "mine";
  const auto result = run({"--report", file});
  EXPECT_EQ(result.exit_code, 1);
  const std::string reason = "cannot make the folder '" + file.string() + "': Not a directory";
  EXPECT_EQ(result.out, R"({"status":"not_started","reason":")" + reason + "\"}\n");
  EXPECT_EQ(result.err, "armature: " + reason + "\n");
}

TEST_F(RunForAScript, AFolderOfARecordingThatCannotBeMadeIsToldBeforeTheRun) {
  const fs::path file = folder_ / "file";
  std::ofstream{file} << "mine";
  const auto result = run({"--set", "record.file=" + (file / "run.mcap").string()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, testing::HasSubstr("armature: cannot make the folder '" + file.string() +
                                             "': Not a directory\n"));
}

TEST_F(RunForAScript, AReportThatCannotBeWrittenFailsTheRunAndTheFiguresArePrinted) {
  fs::create_directories(folder_ / "report.json");
  const auto result = run({"--report", folder_.path()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(result.out)["status"], "ok");
  EXPECT_THAT(result.err,
              testing::HasSubstr("armature: cannot write '" + (folder_ / "report.json").string() +
                                 "': it is no regular file\n"));
}

TEST_F(RunForAScript, ATableOfJointsThatCannotBeMadeIsToldBeforeTheRun) {
  const fs::path table = folder_ / "arm_joints.csv";
  fs::create_directories(table);
  const auto result = run({"--report", folder_.path()});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err,
              testing::HasSubstr("cannot write '" + table.string() + "': it is no regular file"));
}

TEST_F(RunForAScript, TheReportIsWhatIsPrinted) {
  const auto result = run({"--report", folder_.path()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(report(), result.out);
}

TEST_F(RunForAScript, AProcessorThatThisMachineLacksIsRefusedWhereAThreadIsToStayOnIt) {
  const auto simulated = run({"--set", "executors.control.cpu=1023"});
  EXPECT_EQ(simulated.exit_code, 0) << simulated.err;
  const auto result = run({"--set", "executors.control.cpu=1023", "--set", "clock=system"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(
      result.out,
      R"({"status":"not_started","reason":"executor 'control': 'cpu' is 1023, this machine has 0 to )" +
          std::to_string(sysconf(_SC_NPROCESSORS_CONF) - 1) + "\"}\n");
}

TEST_F(RunForAScript, TheMainProcessThatIsStartedByHandJudgesTheGoals) {
  const auto result = run({"--process", "main", "--set", "goals={target_error_mm: 0.000001}"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(result.out)["status"], "goals_missed") << result.out;
  const auto met = run({"--process", "main"});
  EXPECT_EQ(met.exit_code, 0) << met.err;
  EXPECT_TRUE(nlohmann::json::parse(met.out).contains("target_error_mm")) << met.out;
}

TEST_F(RunForAScript, AReportIsOfTheWholeRunAndNotOfOneProcess) {
  const auto result = run({"--process", "main", "--report", folder_.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, testing::HasSubstr("--process excludes --report"));
}

TEST_F(RunForAScript, TwoRunsNeverWriteIntoOneReportFolder) {
  const std::vector<std::string> words{"--keep-running", "--set", "clock=system", "--report",
                                       folder_.path()};
  std::vector<std::string> first{armature(), "run", source_file("configs/sr1_biopsy.yaml"),
                                 "--domain", std::to_string(domain_)};
  first.insert(first.end(), words.begin(), words.end());
  Command running{first};
  ASSERT_TRUE(running.wait_for_err("task      approach", std::chrono::seconds{30}))
      << running.err();
  std::vector<std::string> other = words;
  other.insert(other.end(), {"--set", "name=another"});
  for (const auto& second : {words, other}) {
    const auto refused = run(second);
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.err, testing::HasSubstr("another run writes its report into '" +
                                                folder_.path().string() + "' (pid " +
                                                std::to_string(running.pid()) + ")"));
    EXPECT_FALSE(fs::exists(folder_ / "report.json")) << report();
  }
  running.signal(SIGINT);
  const auto result = running.finish(std::chrono::seconds{30});
  EXPECT_THAT(result.err, testing::Not(testing::HasSubstr("removed")));
  EXPECT_TRUE(fs::exists(folder_ / "run.mcap"));
  EXPECT_TRUE(fs::exists(folder_ / "report.html")) << result.err;
}

TEST_F(RunForAScript, ARecordingThatAnotherProgramWritesIntoTheReportFolderStays) {
  Command recorder{
      {armature(), "record", "-o", folder_ / "run.mcap", "--domain", std::to_string(domain_)}};
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{30};
  const auto is_begun = [&] {
    std::error_code none;
    return fs::file_size(folder_ / "run.mcap", none) > 0 && !none;
  };
  while (!is_begun() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  const auto refused = run({"--report", folder_.path()});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, testing::HasSubstr("is being written by another program"));
  EXPECT_TRUE(fs::exists(folder_ / "run.mcap"));
}

TEST_F(RunForAScript, FilesOfAnOlderRunGoFromTheFolderAndThoseOfOthersStay) {
  fs::create_directories(folder_.path());
  std::ofstream{folder_ / "notes.txt"} << "mine";
  const auto first =
      run_command({armature(), "run", source_file("configs/sr1_biopsy.yaml"), "--json", "--report",
                   folder_.path(), "--domain", std::to_string(domain_)});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  for (const char* name : {"arm_joints.csv", "arm_joints.svg", "report.html", "run.mcap"}) {
    EXPECT_TRUE(fs::exists(folder_ / name)) << name;
  }
  const auto checked =
      run_command({"/usr/bin/env", "-C", folder_.path(), "sha256sum", "-c", "report.sha256"});
  EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
  EXPECT_THAT(checked.out, testing::HasSubstr("arm_joints.csv: OK\n"));
  EXPECT_THAT(checked.out, testing::HasSubstr("report.html: OK\n"));
  std::ofstream{folder_ / "arm_joints.svg", std::ios::app} << "<!-- seen by me -->";
  const auto refused =
      run({"--report", folder_.path(), "--set", "components.motion.ik.plugin=ik/numerc"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err,
              testing::HasSubstr(
                  "'" + (folder_ / "arm_joints.svg").string() +
                  "' is of an older run into this folder; it stays, as it was changed since\n"));
  std::vector<std::string> left;
  for (const auto& entry : fs::directory_iterator{folder_.path()})
    left.push_back(entry.path().filename());
  EXPECT_THAT(left, testing::UnorderedElementsAre("notes.txt", "arm_joints.svg", "report.json"));
}

}  // namespace
}  // namespace armature::test
