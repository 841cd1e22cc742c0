// SPDX-License-Identifier: Apache-2.0
// A run that records itself: what is in its recording, around which troubles it is written, and
// when the run is refused because of it.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>

#include "armature/recording/mcap_reader.hpp"
#include "armature/values/file_content.hpp"
#include "replay_test.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

/// What an attachment of a recording says.
std::string attached(const std::string& file, const std::string& name) {
  McapReader reader{file};
  while (reader.next()) continue;
  for (const McapAttachment& attachment : reader.attachments()) {
    if (attachment.name == name) return attachment.data;
  }
  return {};
}

TEST_F(Replay, ARunOnTheSimulatedClockComesBackBitForBitWithTheFiguresThatItTold) {
  const CommandResult run = record({"--set", "clock=simulated", "--json"});
  const json told = json::parse(run.out);
  const json figures = json::parse(attached(file(), "figures.json"));
  EXPECT_EQ(figures["status"], told["status"]);
  EXPECT_EQ(figures["reasons"], told["reasons"]) << "its time was over before its end";
  EXPECT_GT(figures["figures"].size(), 5U);
  for (const json& figure : figures["figures"]) {
    EXPECT_EQ(figure["value"], told[std::string{figure["key"]}]) << figure;
    if (figure["key"] != "mouth_position_error_mm") continue;
    EXPECT_EQ(figure["title"], "mouth position error [mm]");
    EXPECT_EQ(figure["goal"], 2.5);
  }
  EXPECT_GT(figures["timing"]["components"]["motion"]["step"]["count"], 3'900);
  EXPECT_FALSE(told.contains("timing")) << "nobody asked for it";
  EXPECT_EQ(run_command({armature(), "info", "--verify", file()}).exit_code, 0);
  const json checked = check({file()}, 0);
  EXPECT_TRUE(checked["identical"]);
  EXPECT_EQ(std::ranges::count_if(checked["components"],
                                  [](const json& component) {
                                    return component["component"] == "motion" &&
                                           component["activations"] > 3'900;
                                  }),
            1)
      << "none of 4 s was lost";
}

TEST_F(Replay, ARunThatRecordsItselfHasWhatItsPageShows) {
  record_shortly();
  const json info = json::parse(run_command({armature(), "info", "--json", file()}).out);
  std::set<std::string> topics;
  for (const json& topic : info["topics"]) topics.insert(topic["topic"]);
  for (const char* topic : {"/tf", "/tf_static", "/joint_states", "/robot_description", "/rosout",
                            "/dental_lamp/tool_pose", "/dental_lamp/markers"}) {
    EXPECT_TRUE(topics.contains(topic)) << topic;
  }
  EXPECT_FALSE(topics.contains("/dental_lamp/left/image_raw/compressed"))
      << "a picture is recorded once";
  const CommandResult report =
      run_command({armature(), "report", file(), "-o", file("report.html")}, {}, kEnough);
  EXPECT_EQ(report.exit_code, 0);
  EXPECT_EQ(report.err, "");
}

TEST_F(Replay, TheReportOfARunHasItsPage) {
  const fs::path out = folder_ / "out 50%d";
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {armature(), "run", source_file("configs/dental_lamp.yaml"), "--json",
                               "--report", out, "--set", "run.time_limit_s=1.5", "--domain",
                               std::to_string(unique_dds_domain())});
    return run_command(more, {}, kEnough);
  };
  for (int times = 0; times < 2; ++times) {  // the second takes the place of the first
    const CommandResult result = run({});
    EXPECT_EQ(json::parse(result.out)["status"], "goals_missed") << "nothing else on the output";
    EXPECT_NE(content_of(out / "report.html").find("data-figures=\"{&quot;status&quot;"),
              std::string::npos);
    const CommandResult replay = run_command({armature(), "replay", "--check", out / "run.mcap"});
    EXPECT_EQ(replay.exit_code, 1);
    EXPECT_THAT(replay.err, HasSubstr("only what a page of the run shows"));
  }
  EXPECT_LT(fs::file_size(out / "run.mcap"), 8'000'000U);
  fs::remove_all(out);
  run({"--set", "record.file=" + file()});
  EXPECT_TRUE(fs::exists(out / "report.html"));
  EXPECT_FALSE(fs::exists(out / "run.mcap")) << "it has a recording of its own";
  const CommandResult around =
      run({"--set", "record={file: \"" + file("%H.mcap") + "\", around_faults_s: 1}"});
  EXPECT_THAT(around.err, HasSubstr("so its report has no page"));
  EXPECT_FALSE(fs::exists(out / "report.html")) << "that of the run before";
}

TEST_F(Replay, AResultThatCannotBePrintedCostsNeitherReportNorRecording) {
  const std::string run = armature() + " run " + source_file("configs/sr1_biopsy.yaml") +
                          " --json --timing --report '" + folder_.path().string() +
                          "' --set record.file=" + file() + " --domain " +
                          std::to_string(unique_dds_domain());
  const CommandResult result = run_command({"/bin/sh", "-c", run + " > /dev/full"}, {}, kEnough);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("the result was not printed: No space left on device"));
  EXPECT_EQ(json::parse(content_of(folder_ / "report.json"))["status"], "ok");
  EXPECT_TRUE(fs::exists(folder_ / "report.html"));
  EXPECT_EQ(run_command({armature(), "info", file(), "--verify"}).exit_code, 0);
}

TEST_F(Replay, WhatHappenedAroundATroubleIsInAFileOfItsOwn) {
  const fs::path named = file("trouble-%H.mcap");
  Command run{{armature(), "run", source_file("configs/dental_lamp.yaml"), "--set",
               "record={file: \"" + named.string() + "\", around_faults_s: 1}", "--inject",
               "monitor:throw", "--domain", std::to_string(unique_dds_domain())}};
  ASSERT_TRUE(run.wait_for_err("aligning", kEnough));
  EXPECT_TRUE(fs::is_empty(folder_.path())) << "nothing has happened yet";
  run.signal(SIGUSR1);
  const CommandResult result = run.finish(kEnough);
  EXPECT_THAT(result.err, HasSubstr("what happened around the trouble is recorded: "));
  // Around the end of the run, which has a fault, is another one: "trouble-10-2.mcap".
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator{folder_.path()}) files.push_back(entry.path());
  ASSERT_FALSE(files.empty());
  const std::string written = *std::ranges::min_element(files, {}, &std::string::size);
  const json info =
      json::parse(run_command({armature(), "info", written, "--json", "--verify"}).out);
  EXPECT_TRUE(info["whole"]);
  EXPECT_GT(info["length_s"], 1.0) << "before and after";
  EXPECT_LT(info["length_s"], 4.0);
  std::set<std::string> topics;
  for (const json& topic : info["topics"]) {
    if (topic["messages"] > 0) topics.insert(topic["topic"]);
  }
  for (const char* latched : {"/robot_description", "/tf_static", "/dental_lamp/description"}) {
    EXPECT_TRUE(topics.contains(latched)) << latched;
  }
  const CommandResult replay = run_command({armature(), "replay", written, "--check"});
  EXPECT_EQ(replay.exit_code, 1);
  EXPECT_THAT(replay.err, HasSubstr("begins in the midst of a run"));
}

TEST_F(Replay, AGoalThatIsMissedIsATroubleAroundWhichIsRecorded) {
  const CommandResult run =
      run_command({armature(), "run", source_file("configs/sr1_biopsy.yaml"), "--set",
                   "record={file: \"" + file("trouble-%H.mcap") + "\", around_faults_s: 1}",
                   "--set", "goals.target_error_of_bound_999=0.1", "--json", "--domain",
                   std::to_string(unique_dds_domain())},
                  {}, kEnough);
  EXPECT_EQ(json::parse(run.out)["status"], "goals_missed") << run.err;
  EXPECT_THAT(run.err, HasSubstr("what happened around the trouble is recorded: "));
  ASSERT_FALSE(fs::is_empty(folder_.path()));
  const std::string written = fs::directory_iterator { folder_.path() } -> path();
  EXPECT_EQ(json::parse(attached(written, "figures.json"))["status"], "goals_missed");
}

TEST_F(Replay, ANameWithoutAFolderIsInTheFolderWhereTheRunIs) {
  const std::string run = armature() + " run " + source_file("configs/dental_lamp.yaml") +
                          " --set record.file=here.mcap --set run.time_limit_s=1 --domain " +
                          std::to_string(unique_dds_domain());
  run_command({"/bin/sh", "-c", "cd '" + folder_.path().string() + "' && " + run}, {}, kEnough);
  EXPECT_TRUE(fs::exists(file("here.mcap")));
}

TEST_F(Replay, ARecordingThatIsThereStopsARunBeforeItBegins) {
  std::ofstream{file()} << "yesterday's";
  const CommandResult run = record({});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("is there already: move it, or let the name say the time"));
  EXPECT_EQ(fs::file_size(file()), 11U);
}

TEST_F(Replay, ARecordingThatIsThereStopsAProcessThatTheMainOneDoesNotLookAfter) {
  const std::string part = file("run.vision.mcap");
  std::ofstream{part} << "yesterday's";
  const CommandResult run =
      record({"--process", "vision", "--set", "components.landmarks.process=vision", "--set",
              "components.face.process=vision"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("'" + part + "' is there already"));
  EXPECT_EQ(fs::file_size(part), 11U);
}

TEST_F(Replay, AWrongTopicIsFoundBeforeTheRun) {
  const CommandResult run = record({"--set", "record.topics=[/dental_lamp/arm/measured]"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("which no component writes or reads; did you mean "
                                 "'/dental_lamp/arm/measured_js'"));
}

}  // namespace
}  // namespace armature::test
