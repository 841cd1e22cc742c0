// SPDX-License-Identifier: Apache-2.0
// 1. `armature replay --set` compares every component that the change reaches, and only those. 2.
// What it calls recorded is what was recorded. 3. A call that fails on one side only is told.
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>

#include "armature/messages/armature_msgs.hpp"
#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_writer.hpp"
#include "replay_test.hpp"

namespace armature::test {
namespace {

using nlohmann::json;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

constexpr const char* kChange = "components.head.params.marker_error_mm=0.6";

using ChangeMessage = std::function<void(const McapChannel&, std::vector<std::byte>&)>;

/// Changes the messages of a recording, which is whole afterwards, too.
void change_recording(const std::string& file, const ChangeMessage& change) {
  const std::string draft = file + ".draft";
  {
    McapReader reader{file};
    McapWriter writer{draft, {}};
    std::map<std::uint16_t, std::uint16_t> channels;
    std::size_t attachments = 0, metadata = 0;
    const auto copy_surroundings = [&] {
      while (attachments < reader.attachments().size()) {
        writer.attach(reader.attachments()[attachments++]);
      }
      while (metadata < reader.metadata().size()) writer.add(reader.metadata()[metadata++]);
    };
    while (const auto message = reader.next()) {
      copy_surroundings();
      if (!channels.contains(message->channel->id)) {
        McapChannel channel = *message->channel;
        channel.schema_id = writer.add(McapSchema{reader.schemas().at(channel.schema_id)});
        channels[message->channel->id] = writer.add(channel);
      }
      std::vector<std::byte> data{message->data.begin(), message->data.end()};
      change(*message->channel, data);
      writer.write(channels[message->channel->id], message->sequence, message->log_time,
                   message->publish_time, data);
    }
    copy_surroundings();
    writer.close();
  }
  std::filesystem::rename(draft, file);
}

/// As a recording has it in which 'head' has failed.
void make_head_fail(const McapChannel& channel, std::vector<std::byte>& data) {
  if (!channel.topic.ends_with("/activations")) return;
  const MessageType& type = message_type<msg::Activation>();
  msg::Activation activation;
  if (!type.decode(data, &activation) || activation.component_() != "head") return;
  activation.failure_("step failed: no head is there");
  data.clear();
  type.encode(&activation, data);
}

class Compare : public Replay {
 protected:
  CommandResult compare(const std::string& assignment, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {armature(), "replay", file(), "--set", assignment});
    return run_command(more, {}, kEnough);
  }
  /// Of the main process.
  json compared_with(const std::string& assignment, int exit_code) const {
    const CommandResult result = compare(assignment, {"--json"});
    EXPECT_EQ(result.exit_code, exit_code) << result.out << result.err;
    const json all = json::parse(result.out, nullptr, false);
    return all.is_array() && !all.empty() ? all[0] : json::object();
  }
  static json component_of(const json& compared, const std::string& name) {
    for (const json& component : compared.value("components", json::array())) {
      if (component["component"] == name) return component;
    }
    return json::object();
  }
};

// 1.

TEST_F(Compare, AComponentThatTakesAChangedParameterFromAnotherOneIsCompared) {
  constexpr double kUntilTheClutchIsClosed_s = 7;
  record({}, kUntilTheClutchIsClosed_s, "configs/master_manipulator.yaml");
  const json compared = compared_with("components.motion.params.min_depth_mm=95", 0);
  EXPECT_TRUE(component_of(compared, "motion").contains("topics"));
  const json task = component_of(compared, "task");
  ASSERT_TRUE(task.contains("topics")) << "it keeps the instrument as deep as 'motion' does";
  EXPECT_GT(task["topics"]["/master_manipulator/motion/goal"]["differing"], 0) << task;
  EXPECT_FALSE(component_of(compared, "leader_motion").contains("component"));
}

TEST_F(Compare, TheTimeThatAnEndMayTakeReachesEveryComponent) {
  record_needle();
  const json compared = compared_with("run.stop_within_s=5", 0);
  EXPECT_TRUE(component_of(compared, "motion").contains("topics")) << "which asks for it";
  const CommandResult refused = compare("run.stop_within_s=0.1");
  EXPECT_EQ(refused.exit_code, 3) << refused.out;
  EXPECT_THAT(refused.err, HasSubstr("stop_within_s"));
}

TEST_F(Compare, AValueThatIsOnlyWrittenOtherwiseChangesNothing) {
  record_needle();
  const CommandResult same = compare("components.head.params.marker_error_mm=5.0e-1");
  EXPECT_EQ(same.exit_code, 3);
  EXPECT_THAT(same.err, HasSubstr("change no component of the recording"));
}

// 2.

TEST_F(Compare, WhatDoesNotRepeatTheRecordingIsToldAndIsNoDifferenceOfTheChangeOnly) {
  record_needle();
  const json whole = compared_with(kChange, 0);
  EXPECT_EQ(whole["repeats"], true);
  EXPECT_FALSE(component_of(whole, "head").contains("not_repeated"));
  change_recording(file(), [](const McapChannel& channel, std::vector<std::byte>& data) {
    if (channel.topic.ends_with("/head/markers")) data.back() ^= std::byte{1};
  });
  const json compared = compared_with(kChange, 1);
  EXPECT_EQ(compared["repeats"], false);
  EXPECT_EQ(compared["complete"], true) << "all was repeated";
  const json told = component_of(compared, "head").value("not_repeated", json::object());
  EXPECT_EQ(told.value("topic", ""), "/sr1_biopsy/head/markers");
  EXPECT_EQ(told.value("at_s", -1.0), 0);
  EXPECT_THAT(compare(kChange).out,
              HasSubstr("'head' does not repeat what was recorded (first at 0.000 s): its "
                        "differences are not those of the change only"));
}

TEST_F(Compare, WhatIsNotInTheRecordingCannotBeHeldToIt) {
  record({"--set", "record.topics=[/sr1_biopsy/head/truth]"}, 2, "configs/sr1_biopsy.yaml");
  const json compared = compared_with(kChange, 1);
  EXPECT_EQ(compared["repeats"], true) << "as far as it is known";
  EXPECT_EQ(compared["complete"], false);
  EXPECT_EQ(component_of(compared, "head").value("not_recorded", 0), 2) << "the markers, the plan";
  EXPECT_THAT(compare(kChange).out,
              HasSubstr("not compared with the recording: 2 outputs of 'head'"));
}

TEST_F(Compare, ARecordingOfAnotherProcessorIsRefusedAsByCheck) {
  record_needle();
  // The level of the processor stands between other texts of the same length.
  std::fstream recording{file(), std::ios::in | std::ios::out | std::ios::binary};
  const std::string bytes{std::istreambuf_iterator<char>{recording}, {}};
  const std::size_t level = bytes.find("x86-64-v");
  if (level == std::string::npos) GTEST_SKIP() << "only known of x86-64";
  recording.seekp(static_cast<std::streamoff>(level));
  recording.write("x86-64-v9", 9);
  recording.close();
  const CommandResult refused = compare(kChange);
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("--allow-ulp"));
  EXPECT_THAT(compare(kChange, {"--allow-ulp"}).out, HasSubstr("'head', "));
}

// 3.

TEST_F(Compare, AFailureOfTheRecordingThatDoesNotComeAgainIsToldWithItsText) {
  record_needle();
  change_recording(file(), make_head_fail);
  const json compared = compared_with(kChange, 1);
  const json head = component_of(compared, "head");
  EXPECT_EQ(head.value("not_repeated", json::object()).value("topic", "none"), "") << head;
  const json failure = head.value("failure", json::object());
  EXPECT_EQ(failure.value("recorded", ""), "step failed: no head is there");
  EXPECT_EQ(failure.value("now", "none"), "");
  EXPECT_THAT(compare(kChange).out,
              AllOf(HasSubstr("'head' does not repeat what was recorded (first at 0.000 s)"),
                    HasSubstr("at 0.000 s, 'head': recorded 'step failed: no head is there', now "
                              "it does not fail")));
}

TEST_F(Compare, AFailureThatOnlyTheChangeHasOrHasNotIsToldWithItsText) {
  const Command::Options plugins{.environment = {{"ARMATURE_PLUGIN_PATH", TEST_PLUGINS}},
                                 .input = {}};
  const std::string joint = "components.sensor.params.joint=", none = joint + "99";
  const auto run_with = [&](const std::string& setting, const std::string& name) {
    return run_command(
        {armature(), "run", source_file("tests/faults/tour.yaml"),
         source_file("tests/end_to_end/lying_sensor.yaml"), "--set", "clock=simulated", "--set",
         "run.time_limit_s=0.5", "--set", "record.file=" + file(name), "--set",
         "components.truth.params.file=" + file(name + ".joints"), "--set", setting, "--domain",
         std::to_string(unique_dds_domain())},
        plugins, kEnough);
  };
  const auto compare_with = [&](const std::string& setting, const std::string& name) {
    return run_command({armature(), "replay", file(name), "--set", setting}, plugins, kEnough);
  };
  run_with(joint + "0", "sound.mcap");
  const CommandResult broken = compare_with(none, "sound.mcap");
  EXPECT_EQ(broken.exit_code, 1) << "it is repeated up to there";
  EXPECT_THAT(broken.out,
              ContainsRegex("'sensor': recorded it does not fail, now 'step failed: vector.*7\\)'"))
      << "the whole text";
  EXPECT_THAT(broken.out, Not(HasSubstr("does not repeat")));
  run_with(none, "broken.mcap");
  const CommandResult mended = compare_with(joint + "0", "broken.mcap");
  EXPECT_EQ(mended.exit_code, 0) << mended.err;
  EXPECT_THAT(mended.out, HasSubstr("'sensor': recorded 'step failed: vector"));
  EXPECT_THAT(mended.out, HasSubstr(", now it does not fail"));
  EXPECT_THAT(mended.out, Not(HasSubstr("does not repeat")));
}

}  // namespace
}  // namespace armature::test
