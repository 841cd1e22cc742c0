// SPDX-License-Identifier: Apache-2.0
// 1. What a deployment records of itself comes back bit for bit, on whichever clock, in however
//    many processes and threads it ran. 2. A component that does something else than it did is
//    named, with the place of the first difference. 3. What cannot be compared is told.
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_writer.hpp"
#include "replay_test.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

/// As a queue leaves it that dropped the last `count` activations, or all; when all, the count of
/// them that stands at its end is left out, too.
void copy_without_last_activations(const std::string& from, std::uint32_t count,
                                   const std::string& to) {
  const auto is_activation = [](const McapMessage& message) {
    return message.channel->topic.ends_with("/activations");
  };
  std::uint32_t last = 0;
  {
    McapReader reader{from};
    while (const auto message = reader.next()) {
      if (is_activation(*message)) last = message->sequence;
    }
  }
  McapReader reader{from};
  McapWriter writer{to, {}};
  std::map<std::uint16_t, std::uint16_t> channels;
  std::size_t attachments = 0, metadata = 0;
  const auto copy_surroundings = [&] {
    while (attachments < reader.attachments().size()) {
      writer.attach(reader.attachments()[attachments++]);
    }
    while (metadata < reader.metadata().size()) {
      McapMetadata one = reader.metadata()[metadata++];
      if (count >= last) one.values.erase("activations");
      writer.add(one);
    }
  };
  while (const auto message = reader.next()) {
    copy_surroundings();
    if (is_activation(*message) && (count >= last || message->sequence > last - count)) continue;
    if (!channels.contains(message->channel->id)) {
      McapChannel channel = *message->channel;
      channel.schema_id = writer.add(McapSchema{reader.schemas().at(channel.schema_id)});
      channels[message->channel->id] = writer.add(channel);
    }
    writer.write(channels[message->channel->id], message->sequence, message->log_time,
                 message->publish_time, message->data);
  }
  copy_surroundings();
  writer.close();
}

/// Of the components that did something else.
std::map<std::string, json> differences_of(const json& checked) {
  std::map<std::string, json> differences;
  for (const json& component : checked["components"]) {
    if (component.contains("difference")) {
      differences[component["component"]] = component["difference"];
    }
  }
  return differences;
}

json component_of(const json& checked, const std::string& name) {
  for (const json& component : checked["components"]) {
    if (component["component"] == name) return component;
  }
  return {};
}

TEST_F(Replay, ARunOnTheSystemClockComesBackBitForBit) {
  const CommandResult run = record({});
  EXPECT_THAT(run.err, HasSubstr("recorded: " + file()));
  EXPECT_THAT(run.err, Not(HasSubstr("came faster")));
  const json checked = check({file()}, 0);
  EXPECT_TRUE(checked["identical"]);
  EXPECT_GT(checked["outputs"], 10'000);
  for (const char* name : {"scene", "landmarks", "face", "target", "task", "motion",
                           "motion.planner", "arm", "report"}) {
    const json component = component_of(checked, name);
    EXPECT_FALSE(component.contains("not_replayed")) << component;
    EXPECT_FALSE(component.contains("ends")) << component;
    EXPECT_GT(component["activations"], 0) << name;
  }
  EXPECT_GT(component_of(checked, "motion")["activations"], 2'000);
}

TEST_F(Replay, ARunInSeveralProcessesComesBackBitForBit) {
  record(
      {"--set", "components.landmarks.process=vision", "--set", "components.face.process=vision"});
  EXPECT_FALSE(fs::exists(file("run.vision.mcap"))) << "it is in the one that was named";
  EXPECT_EQ(run_command({armature(), "info", "--verify", file()}).exit_code, 0);
  const json checked = check({file()}, 0);
  EXPECT_TRUE(checked["identical"]);
  EXPECT_EQ(component_of(checked, "face")["process"], "vision");
  EXPECT_GT(component_of(checked, "face")["outputs"], 0);
  EXPECT_GT(component_of(checked, "target")["outputs"], 0) << "which the other process feeds";
}

TEST_F(Replay, WhatWasJoinedComesBackAsItsPartsDo) {
  const std::string domain = std::to_string(unique_dds_domain());
  const auto process = [&](const std::string& name) {
    return std::vector<std::string>{armature(),
                                    "run",
                                    source_file("configs/dental_lamp.yaml"),
                                    "--set",
                                    "record.file=" + file(),
                                    "--set",
                                    "run.time_limit_s=4",
                                    "--set",
                                    "components.landmarks.process=vision",
                                    "--set",
                                    "components.face.process=vision",
                                    "--domain",
                                    domain,
                                    "--process",
                                    name};
  };
  Command vision{process("vision")};  // started by hand, each keeps the file of its own
  constexpr std::chrono::seconds kMet{60};
  const CommandResult main = run_command(process("main"), {}, kMet);
  const CommandResult apart = vision.finish(kMet);
  ASSERT_THAT(main.err, HasSubstr("stopping: the time limit of 4 s is over")) << apart.err;
  const std::string part = file("run.vision.mcap"), all = file("all.mcap");
  const json of_one = check({file()}, 1);
  EXPECT_FALSE(of_one["complete"]);
  EXPECT_EQ(of_one["missing_processes"], json::array({"vision"}));
  json of_parts = check({file(), part}, 0);
  const CommandResult merge =
      run_command({armature(), "record", "--merge", file(), part, "-o", all}, {}, kEnough);
  EXPECT_EQ(merge.exit_code, 0) << merge.err;
  EXPECT_EQ(run_command({armature(), "info", "--verify", all}).exit_code, 0);
  json of_all = check({all}, 0);
  const json exchanged = of_all["exchanged"];
  EXPECT_GT(exchanged["compared"], 0) << "what one process has read of the other";
  EXPECT_EQ(exchanged["numbered"], exchanged["compared"]);
  EXPECT_EQ(exchanged["unwritten"], 0);
  for (const char* other : {"took_s", "exchanged"}) {
    of_all.erase(other);
    of_parts.erase(other);
  }
  EXPECT_EQ(of_all, of_parts);

  McapReader reader{all};
  std::map<std::string, int> attachments;
  std::uint64_t messages = 0, doubled = 0;
  while (const auto message = reader.next()) {
    ++messages;
    doubled += message->channel->metadata.contains("from") ? 1 : 0;
  }
  for (const McapAttachment& attachment : reader.attachments()) ++attachments[attachment.name];
  for (const auto& [name, count] : attachments) EXPECT_EQ(count, 1) << name;
  EXPECT_TRUE(attachments.contains("dental_lamp/robots/arm.yaml"));
  EXPECT_EQ(exchanged["compared"], doubled) << "each of them, and nothing else";
  const CommandResult report =
      run_command({armature(), "report", all, "-o", file("all.html")}, {}, kEnough);
  EXPECT_THAT(report.out, HasSubstr(" of " + std::to_string(messages - doubled) + " messages"))
      << "a page shows nothing twice";
  const json info = json::parse(run_command({armature(), "info", all, "--json"}).out);
  std::uint64_t counted = 0;
  for (const json& topic : info["topics"]) counted += topic["messages"].get<std::uint64_t>();
  EXPECT_EQ(counted, messages - doubled);
  EXPECT_EQ(info["doubled"], doubled);
}

TEST_F(Replay, AProcessThatWasKilledIsInTheJoinedRecordingAsFarAsItCame) {
  Command run{{armature(), "run", source_file("configs/dental_lamp.yaml"), "--set",
               "record.file=" + file(), "--set", "components.landmarks.process=vision", "--set",
               "components.face.process=vision", "--domain", std::to_string(unique_dds_domain())}};
  ASSERT_TRUE(run.wait_for_err("aligning", kEnough));
  ASSERT_GT(run.child(), 0);
  kill(run.child(), SIGKILL);
  const CommandResult result = run.finish(kEnough);
  EXPECT_THAT(result.err, HasSubstr("joined: " + file()));
  EXPECT_FALSE(fs::exists(file("run.vision.mcap")));
  const CommandResult verified = run_command({armature(), "info", "--verify", file()});
  EXPECT_EQ(verified.exit_code, 0) << "as it was written";
  EXPECT_THAT(verified.out, HasSubstr("incomplete: the part of process 'vision' was cut off"));
  const json checked = check({file()}, 1);
  EXPECT_TRUE(differences_of(checked).empty()) << checked.dump(1);
  EXPECT_FALSE(checked["complete"]);
  EXPECT_EQ(checked["identical"], json{}) << "nobody knows";
  EXPECT_THAT(checked["problems"].dump(),
              HasSubstr("the part of process 'vision' was cut off: it ends"));
  EXPECT_GT(component_of(checked, "face")["outputs"], 0);
  EXPECT_GT(component_of(checked, "motion")["outputs"], 1'000);
}

TEST_F(Replay, AChangedConstantIsFoundAndNamesItsComponentOnly) {
  record({"--set", "clock=simulated"});  // no machine is too busy for a picture
  const json checked =
      check({file(), "--set", "components.target.params.still_speed_m_s=0.00031"}, 1);
  EXPECT_FALSE(checked["identical"]);
  const auto differences = differences_of(checked);
  ASSERT_EQ(differences.size(), 1U) << checked.dump(1);
  const json& difference = differences.at("target");
  EXPECT_EQ(difference["topic"], "/dental_lamp/target");
  EXPECT_GT(difference["activation"], 1);
  EXPECT_GT(difference["ulps"], 0);
  EXPECT_NE(difference["recorded"], difference["replayed"]);
}

TEST_F(Replay, TwoSolversAreComparedOnRecordedDataAndTheirCallsCanBeRepeated) {
  const std::filesystem::path robots = folder_ / "the lamp's robots";
  std::filesystem::copy(source_file("configs/robots"), robots);
  record({"--set", "clock=simulated", "--set",
          "robots.arm=" + (robots / "dental_lamp.yaml").string()});
  const CommandResult result = run_command(
      {armature(), "replay", file(), "--set",
       "components.motion.ik={plugin: ik/numeric, params: {max_restarts: 7}}", "--json"},
      {}, kEnough);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json compared = json::parse(result.out)[0];
  json planner;
  for (const json& component : compared["components"]) {
    EXPECT_THAT(std::string{component["component"]}, testing::StartsWith("motion"));
    if (component["component"] == "motion.planner") planner = component;
  }
  const json& joint_path = planner["topics"]["/dental_lamp/motion/joint_path"];
  EXPECT_GT(joint_path["differing"], 0) << "not one bit differs between two ways to solve";
  EXPECT_LT(joint_path["fields"]["points[].positions[]"]["largest"], 1e-9);
  const json& solver = compared["solvers"][1];
  EXPECT_EQ(solver["recorded"]["plugin"], "ik/lamp_geometric");
  EXPECT_EQ(solver["now"]["plugin"], "ik/numeric");
  EXPECT_GT(solver["now"]["calls"], 0);
  EXPECT_EQ(solver["now"]["calls"], solver["recorded"]["calls"]);
  EXPECT_EQ(solver["now"]["failed"], 0);
  std::string line = solver["now"]["slowest"]["line"];
  line.replace(line.find("armature ik"), 8, armature());
  const CommandResult again = run_command({"/bin/sh", "-c", line});
  EXPECT_EQ(json::parse(again.out)["status"], "ok") << line << again.err;
  EXPECT_THAT(line, HasSubstr("--params '{max_restarts: 7}'"));
}

TEST_F(Replay, AssignmentsThatChangeNothingAreRefused) {
  record_shortly();
  const CommandResult replay =
      run_command({armature(), "replay", file(), "--set", "components.task.params.distance_m=0.5"});
  EXPECT_EQ(replay.exit_code, 3);
  EXPECT_THAT(replay.err, HasSubstr("change no component of the recording"));
}

TEST_F(Replay, AnotherSeedChangesEveryComponent) {
  record_needle();
  const CommandResult replay =
      run_command({armature(), "replay", file(), "--set", "seed=7", "--json"});
  ASSERT_EQ(replay.exit_code, 0) << replay.err;
  const json compared = json::parse(replay.out).at(0);
  EXPECT_EQ(compared["complete"], true);
  const json head = component_of(compared, "head");
  std::uint64_t differing = 0;
  for (const json& topic : head["topics"]) differing += topic["differing"].get<std::uint64_t>();
  EXPECT_GT(differing, 0U) << head.dump(1);
}

TEST_F(Replay, ADamagedRecordingIsComparedAsFarAsItGoesAndThatIsSaid) {
  record_needle();
  fs::resize_file(file(), fs::file_size(file()) / 2);
  const CommandResult replay =
      run_command({armature(), "replay", file(), "--set", "seed=7", "--json"});
  EXPECT_EQ(replay.exit_code, 1);
  EXPECT_THAT(replay.err, HasSubstr(file() + "': it ends in the midst"));
  const json compared = json::parse(replay.out).at(0);
  EXPECT_EQ(compared["process"], "main");
  EXPECT_EQ(compared["complete"], false);
  EXPECT_THAT(compared["problems"].dump(), HasSubstr("it ends in the midst"));
  EXPECT_GT(component_of(compared, "head")["activations"], 0);
}

TEST_F(Replay, WhatIsNotInTheRecordingIsNotCompared) {
  record_shortly({"--set", "record.topics=[/dental_lamp/arm/*]"});
  const json checked = check({file()}, 1);
  EXPECT_FALSE(checked["complete"]);
  EXPECT_EQ(component_of(checked, "landmarks")["ends"],
            "a sample of its input 'left_image' is not in the recording");
  EXPECT_GT(component_of(checked, "arm")["outputs"], 1'000);
  const CommandResult other =
      run_command({armature(), "replay", file(), "--set", "seed=7", "--json"});
  EXPECT_EQ(other.exit_code, 1);
  const json compared = json::parse(other.out).at(0);
  EXPECT_FALSE(compared["complete"]);
  EXPECT_EQ(component_of(compared, "landmarks")["ends"],
            "a sample of its input 'left_image' is not in the recording");
  EXPECT_GT(component_of(compared, "arm")["activations"], 1'000);
}

TEST_F(Replay, ADamagedRecordingAccusesNobody) {
  record_needle();
  std::fstream recording{file(), std::ios::in | std::ios::out | std::ios::binary};
  // In several places: between two chunks stand indexes, of which a replay needs none.
  const auto size = static_cast<std::streamoff>(fs::file_size(file()));
  for (std::streamoff i = 200; i < 300; ++i) {
    recording.seekp(size * i / 400);
    recording.write("damaged!", 8);
  }
  recording.close();
  const json checked = check({file()}, 1);
  EXPECT_TRUE(differences_of(checked).empty()) << checked.dump(1);
  EXPECT_FALSE(checked["complete"]);
  EXPECT_THAT(checked["problems"].dump(), HasSubstr("everything is replayed up to there"));
  EXPECT_GT(checked["outputs"], 0);
}

TEST_F(Replay, ARecordingWithoutItsLastActivationsIsIncompleteAndSaysHowManyAreMissing) {
  record_needle();
  const std::string shorter = file("shorter.mcap");
  copy_without_last_activations(file(), 20, shorter);
  const json checked = check({shorter}, 1);
  EXPECT_EQ(checked["identical"], json{}) << "nobody knows";
  EXPECT_FALSE(checked["complete"]);
  ASSERT_EQ(checked["problems"].size(), 1U) << checked["problems"];
  EXPECT_THAT(std::string{checked["problems"][0]},
              testing::MatchesRegex("the last 20 of the [0-9]+ activations of process 'main' are "
                                    "missing"));
}

TEST_F(Replay, OfWhichNothingWasRepeatedIsNotCalledIdentical) {
  record_needle();
  const std::string nothing = file("nothing.mcap");
  copy_without_last_activations(file(), std::numeric_limits<std::uint32_t>::max(), nothing);
  const json checked = check({nothing}, 1);
  EXPECT_EQ(checked["activations"], 0);
  EXPECT_EQ(checked["identical"], json{}) << "nobody knows";
  EXPECT_FALSE(checked["complete"]);
  const CommandResult told = run_command({armature(), "replay", "--check", nothing});
  EXPECT_THAT(told.out, testing::StartsWith("incomplete"));
}

TEST_F(Replay, ARepairedRecordingIsIncompleteAndSaysWhatItWasMadeOf) {
  record_needle();
  const std::string cut = file("cut.mcap"), whole = file("whole.mcap");
  fs::copy_file(file(), cut);
  fs::resize_file(cut, fs::file_size(cut) * 3 / 4);
  ASSERT_EQ(run_command({armature(), "record", "--repair", cut, "-o", whole}).exit_code, 0);
  const json checked = check({whole}, 1);
  EXPECT_EQ(checked["identical"], json{}) << "nobody knows";
  EXPECT_FALSE(checked["complete"]);
  EXPECT_GT(checked["outputs"], 0);
  EXPECT_EQ(checked["problems"], (json{"it was repaired from 'cut.mcap', which was cut off",
                                       "the recording of process 'main' has no end"}));
}

TEST_F(Replay, AFailureIsRecordedAndAReplayWithoutItDiffers) {
  Command run{{armature(), "run", source_file("configs/dental_lamp.yaml"), "--set",
               "record.file=" + file(), "--inject", "motion:throw", "--domain",
               std::to_string(unique_dds_domain())}};
  ASSERT_TRUE(run.wait_for_err("searching 1", kEnough));
  run.signal(SIGUSR1);
  run.finish(kEnough);
  const auto differences = differences_of(check({file()}, 1));
  ASSERT_TRUE(differences.contains("motion"));
  EXPECT_EQ(differences.size(), 1U);
}

TEST_F(Replay, WhatARunHasWrittenIsNotWrittenAgain) {
  record({"--set", "clock=simulated", "--set",
          "components.rows={plugin: report/joints, params: {file: " + file("rows") + "}}"});
  ASSERT_TRUE(fs::exists(file("rows.csv")));
  std::ofstream{file("rows.csv")} << "mine";
  const json checked = check({file()}, 0);
  EXPECT_THAT(std::string{component_of(checked, "rows")["not_replayed"]},
              HasSubstr("writes files"));
  EXPECT_EQ(fs::file_size(file("rows.csv")), 4U);
}

TEST_F(Replay, WhatWasFoundInAVolumeIsFoundAgainWhereTheVolumeIsAsItWas) {
  const fs::path scan = file("scan.nrrd");
  const CommandResult run = run_command(
      {armature(), "run", source_file("configs/sr1_from_images.yaml"), "--set",
       "record.file=" + file(), "--set", "components.tomograph.params.file=" + scan.string(),
       "--domain", std::to_string(unique_dds_domain())},
      {}, kEnough);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json checked = check({file()}, 0);
  EXPECT_TRUE(checked["identical"]);
  for (const char* name : {"markers", "planner", "sections"}) {
    EXPECT_FALSE(component_of(checked, name).contains("not_replayed")) << name;
    EXPECT_GT(component_of(checked, name)["outputs"], 0) << name;
  }
  EXPECT_THAT(std::string{component_of(checked, "tomograph")["not_replayed"]},
              HasSubstr("writes files"));
  {
    std::fstream voxels{scan, std::ios::in | std::ios::out | std::ios::binary};
    voxels.seekp(-1, std::ios::end);
    voxels.put('\x7F');
  }
  const json changed = check({file()}, 0);
  EXPECT_THAT(std::string{component_of(changed, "markers")["not_replayed"]},
              HasSubstr("and '" + scan.string() +
                        "' holds another volume than the one that was announced; put back the one "
                        "with "));
  fs::remove(scan);
  const json gone = check({file()}, 0);
  EXPECT_TRUE(gone["identical"]) << "of the others";
  for (const char* name : {"markers", "planner", "sections"}) {
    EXPECT_THAT(std::string{component_of(gone, name)["not_replayed"]},
                HasSubstr("there is no '" + scan.string() + "'"));
  }
}

TEST_F(Replay, FilesOfDifferentRunsAreRefused) {
  record_needle();
  fs::rename(file(), file("first.mcap"));
  record_needle();
  const CommandResult replay =
      run_command({armature(), "replay", "--check", file("first.mcap"), file()}, {}, kEnough);
  EXPECT_EQ(replay.exit_code, 3);
  EXPECT_THAT(replay.err, HasSubstr("are of different runs"));
}

TEST_F(Replay, AnotherProcessorIsRefusedUnlessLastBitsMayDiffer) {
  record_needle();
  // The level of the processor stands between other texts of the same length.
  std::fstream recording{file(), std::ios::in | std::ios::out | std::ios::binary};
  std::string bytes{std::istreambuf_iterator<char>{recording}, {}};
  const std::size_t level = bytes.find("x86-64-v");
  if (level == std::string::npos) GTEST_SKIP() << "only known of x86-64";
  recording.seekp(static_cast<std::streamoff>(level));
  recording.write("x86-64-v9", 9);
  recording.close();
  const CommandResult refused = run_command({armature(), "replay", file(), "--check"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("--allow-ulp"));
  const CommandResult allowed =
      run_command({armature(), "replay", file(), "--check", "--allow-ulp"}, {}, kEnough);
  EXPECT_THAT(allowed.out, HasSubstr("identical as far as it was compared: "));
  EXPECT_TRUE(allowed.out.ends_with('\n'));
  EXPECT_THAT(allowed.err, HasSubstr(file())) << "a byte has been changed";
}

TEST_F(Replay, ARecordingFromOutsideHasNoActivations) {
  McapWriter empty{file(), {}};
  empty.close();
  const CommandResult replay = run_command({armature(), "replay", file(), "--check"});
  EXPECT_EQ(replay.exit_code, 1);
  EXPECT_THAT(replay.err, HasSubstr("holds no activations"));
}

}  // namespace
}  // namespace armature::test
