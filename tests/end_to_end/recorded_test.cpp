// SPDX-License-Identifier: Apache-2.0
// `armature record`: what runs is in a file afterwards, whatever ends the recording.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cctype>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_writer.hpp"
#include "armature/values/temporary_folder.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::chrono::seconds kEnough{60};

class Recorded : public testing::Test {
 protected:
  std::vector<std::string> record(std::vector<std::string> more) const {
    more.insert(more.begin(), {armature(), "record", "-o", file_});
    more.insert(more.end(), {"--domain", std::to_string(domain_)});
    return more;
  }
  json info(const std::string& file, int exit_code) const {
    const CommandResult result = run_command({armature(), "info", file, "--json"});
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    return json::parse(result.out);
  }
  /// How many messages of a topic `info` tells of.
  static std::uint64_t messages_of(const std::string& topic, const json& info) {
    for (const json& one : info["topics"]) {
      if (one["topic"] == topic) return one["messages"];
    }
    return 0;
  }
  static std::uint64_t all_messages(const json& info) {
    std::uint64_t count = 0;
    for (const json& one : info["topics"]) count += one["messages"].get<std::uint64_t>();
    return count;
  }

  const int domain_ = unique_dds_domain();
  const TemporaryFolder folder_;
  const std::string file_ = folder_ / "run.mcap";
  Command run_{{armature(), "run", source_file("tests/end_to_end/arm_watched.yaml"), "--set",
                "clock=system", "--domain", std::to_string(domain_)}};
};

const std::string kJoints = "/watched/arm/measured_js";

TEST_F(Recorded, ARunIsInTheFileWithWhatItWasMadeFrom) {
  const CommandResult result = run_command(record({"--timeout", "5", "--json"}), {}, kEnough);
  ASSERT_EQ(result.exit_code, 0) << result.err << run_.err();
  const json told = json::parse(result.out);
  EXPECT_EQ(told["dropped"], 0);
  const json in_it = info(file_, 0);
  EXPECT_EQ(all_messages(in_it), told["messages"]);
  EXPECT_GT(messages_of(kJoints, in_it), 1000U);
  std::vector<std::string> attached;
  for (const json& attachment : in_it["attachments"]) attached.push_back(attachment["name"]);
  EXPECT_THAT(attached, Contains("watched/watched.yaml"));
  EXPECT_THAT(attached, Contains("watched/robots/arm.yaml"));
  EXPECT_EQ(in_it["metadata"][0]["values"]["deployment"], "watched");
  EXPECT_EQ(in_it["metadata"][0]["values"]["fingerprint"].get<std::string>().size(), 64U);

  // Each topic in the order in which it was written, and none twice.
  std::map<std::string, Time> last;
  McapReader reader{file_};
  while (const auto message = reader.next()) {
    const auto [place, is_first] = last.try_emplace(message->channel->topic, message->publish_time);
    EXPECT_TRUE(is_first || message->publish_time > place->second) << message->channel->topic;
    place->second = message->publish_time;
  }
  std::map<std::string, std::string> qos;
  for (const auto& [id, channel] : reader.channels()) {
    EXPECT_EQ(reader.schemas().at(channel.schema_id).encoding, "ros2msg") << channel.topic;
    if (channel.metadata.contains("qos")) qos[channel.topic] = channel.metadata.at("qos");
  }
  EXPECT_EQ(qos["/tf_static"], "latched");
  EXPECT_FALSE(qos.contains(kJoints));
}

TEST_F(Recorded, OnlyWhatIsAskedForIsInTheFile) {
  const CommandResult result =
      run_command(record({kJoints, "/tf*", "--uncompressed", "--timeout", "4"}), {}, kEnough);
  ASSERT_EQ(result.exit_code, 0) << result.err << run_.err();
  const json in_it = info(file_, 0);
  std::vector<std::string> topics;
  for (const json& one : in_it["topics"]) topics.push_back(one["topic"]);
  EXPECT_THAT(topics, testing::UnorderedElementsAre(kJoints, "/tf", "/tf_static"));
  EXPECT_EQ(in_it["packed_bytes"], in_it["unpacked_bytes"]);
}

TEST_F(Recorded, ARecordingThatDiesIsReadableToItsLastChunkAndCanBeMadeWhole) {
  Command recording{record({})};
  const auto give_up = std::chrono::steady_clock::now() + kEnough;
  while (!fs::exists(file_) || fs::file_size(file_) < 50'000) {
    ASSERT_LT(std::chrono::steady_clock::now(), give_up) << recording.err() << run_.err();
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  recording.signal(SIGKILL);
  EXPECT_EQ(recording.finish(kEnough).exit_code, 128 + SIGKILL);
  const json cut = info(file_, 1);
  EXPECT_EQ(cut["whole"], false);
  EXPECT_GT(messages_of(kJoints, cut), 100U);
  const std::string whole = folder_ / "whole.mcap";
  const CommandResult repaired =
      run_command({armature(), "record", "--repair", file_, "-o", whole});
  EXPECT_EQ(repaired.exit_code, 0) << repaired.err;
  const json mended = info(whole, 0);
  EXPECT_EQ(all_messages(mended), all_messages(cut));
  EXPECT_EQ(mended["attachments"], cut["attachments"]);

  // The chain tells how far the file is as it was written, and the new one what it was made of.
  const CommandResult verified = run_command({armature(), "info", file_, "--verify"});
  EXPECT_EQ(verified.exit_code, 1);
  EXPECT_THAT(verified.err, ContainsRegex("run.mcap': cut off after [-0-9]+ [:0-9.]+ UTC: the "
                                          "chain is right up to there, [0-9]+ chunks"));
  EXPECT_EQ(run_command({armature(), "info", whole, "--verify"}).exit_code, 0);
  const json from = mended["metadata"].back();
  EXPECT_EQ(from["name"], "armature.repaired");
  EXPECT_EQ(from["values"]["chain"], "cut");
  EXPECT_EQ(from["values"]["file"], "run.mcap");
  EXPECT_THAT(run_command({"/usr/bin/sha256sum", file_}).out,
              HasSubstr(from["values"]["sha256"].get<std::string>()));
}

TEST_F(Recorded, AByteThatIsChangedAfterwardsIsFound) {
  const CommandResult result = run_command(record({"--timeout", "4", "--json"}), {}, kEnough);
  ASSERT_EQ(result.exit_code, 0) << result.err << run_.err();
  const std::string head = json::parse(result.out)["head"];
  const std::vector<std::string> verify{armature(), "info", file_, "--verify", "--head"};
  const auto verify_by = [&](const std::string& hash) {
    std::vector<std::string> words = verify;
    words.push_back(hash);
    return run_command(words);
  };
  EXPECT_EQ(verify_by(head).exit_code, 0);
  EXPECT_THAT(verify_by(head).out,
              ContainsRegex("whole and unchanged: [0-9]+ links, the last is " + head));
  std::string capitals = head;
  for (char& digit : capitals) digit = static_cast<char>(std::toupper(digit));
  EXPECT_EQ(verify_by(capitals).exit_code, 0);
  EXPECT_THAT(verify_by(std::string(64, '0')).err, HasSubstr("it is another file"));
  EXPECT_EQ(verify_by(std::string(64, '0')).exit_code, 1);
  EXPECT_EQ(verify_by("abc").exit_code, 2);

  std::fstream stream{file_, std::ios::binary | std::ios::in | std::ios::out};
  const auto middle = static_cast<std::streamoff>(fs::file_size(file_) / 2);
  stream.seekg(middle);
  const char byte = static_cast<char>(stream.get());
  stream.seekp(middle);
  stream.put(static_cast<char>(byte ^ 1));
  stream.close();
  EXPECT_EQ(run_command({armature(), "info", file_}).exit_code, 0) << "the summary is right";
  EXPECT_EQ(verify_by(head).exit_code, 1);
  EXPECT_THAT(verify_by(head).err,
              ContainsRegex("changed: chunk [0-9]+, within the [0-9]+ bytes from byte [0-9]+"));
}

TEST_F(Recorded, AFileThatIsThereIsNotReplacedUnlessItIsWanted) {
  ASSERT_EQ(run_command(record({"--timeout", "4"}), {}, kEnough).exit_code, 0);
  const auto size = fs::file_size(file_);
  const CommandResult again = run_command(record({"--timeout", "4"}), {}, kEnough);
  EXPECT_EQ(again.exit_code, 3);
  EXPECT_THAT(again.err, HasSubstr("is there already; --force replaces it"));
  EXPECT_EQ(fs::file_size(file_), size);
  EXPECT_EQ(run_command(record({"--timeout", "4", "--force"}), {}, kEnough).exit_code, 0);
}

TEST_F(Recorded, WhatIsReplacedStaysUntilThereIsAWholeRecording) {
  std::ofstream{file_} << "older";
  const auto files = [&] {
    return std::distance(fs::directory_iterator{folder_.path()}, fs::directory_iterator{});
  };
  const CommandResult nothing =
      run_command(record({"/nobody", "--timeout", "1", "--force"}), {}, kEnough);
  EXPECT_EQ(nothing.exit_code, 5);
  EXPECT_THAT(nothing.err, HasSubstr("nothing came to be recorded: '" + file_ + "' is as it was"));
  EXPECT_EQ(fs::file_size(file_), 5U);
  EXPECT_EQ(files(), 1);

  Command recording{record({"--force"})};
  ASSERT_TRUE(recording.wait_for_err("stays until the new recording is whole", kEnough));
  const CommandResult second = run_command(record({"--timeout", "1", "--force"}), {}, kEnough);
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_EQ(second.err, "armature: '" + file_ + "' is being written by another program\n");
  const auto draft = [&]() -> fs::path {
    for (const auto& entry : fs::directory_iterator{folder_.path()}) {
      if (entry.path() != file_) return entry.path();
    }
    return {};
  };
  const auto give_up = std::chrono::steady_clock::now() + kEnough;
  while (draft().empty() || fs::file_size(draft()) < 50'000) {
    ASSERT_LT(std::chrono::steady_clock::now(), give_up) << recording.err() << run_.err();
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  recording.signal(SIGKILL);
  EXPECT_THAT(recording.finish(kEnough).err, HasSubstr(draft().string()));
  EXPECT_EQ(fs::file_size(file_), 5U);
  EXPECT_GT(all_messages(info(draft(), 1)), 0U);

  EXPECT_EQ(run_command(record({"--timeout", "4", "--force"}), {}, kEnough).exit_code, 0);
  EXPECT_EQ(run_command({armature(), "info", file_, "--verify"}).exit_code, 0);
  EXPECT_EQ(files(), 2) << "and the draft of the one that died";
}

TEST_F(Recorded, ARecordingOfNothingLeavesNoFile) {
  for (int times = 0; times < 2; ++times) {
    const CommandResult nothing = run_command(record({"/nobody", "--timeout", "1"}), {}, kEnough);
    EXPECT_EQ(nothing.exit_code, 5) << nothing.err;
    EXPECT_THAT(nothing.err,
                HasSubstr("nothing came to be recorded: '" + file_ + "' is not there"));
    EXPECT_EQ(nothing.out, "");
    EXPECT_FALSE(fs::exists(file_));
  }
}

TEST_F(Recorded, WhatIsBeingRecordedIsNotReplaced) {
  Command first{record({})};
  const auto give_up = std::chrono::steady_clock::now() + kEnough;
  while (!fs::exists(file_) || fs::file_size(file_) < 50'000) {  // one of nothing leaves no file
    ASSERT_LT(std::chrono::steady_clock::now(), give_up) << first.err();
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  const CommandResult second = run_command(record({"--timeout", "1", "--force"}), {}, kEnough);
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_EQ(second.err, "armature: '" + file_ + "' is being written by another program\n");
  first.signal(SIGINT);
  first.finish(kEnough);
  EXPECT_EQ(run_command({armature(), "info", file_, "--verify"}).exit_code, 0);
}

TEST_F(Recorded, ANameThatNobodyWritesIsTold) {
  const CommandResult result =
      run_command(record({kJoints, "/watched/arm/mesured_js", "--timeout", "4"}), {}, kEnough);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("armature: nobody wrote '/watched/arm/mesured_js'\n"));
  const CommandResult pattern = run_command(record({"*joint*"}));
  EXPECT_EQ(pattern.exit_code, 2);
  EXPECT_THAT(pattern.err, HasSubstr("has a '*' that is not at its end"));
}

TEST_F(Recorded, CtrlCEndsTheFileInOrder) {
  Command recording{record({})};
  const auto give_up = std::chrono::steady_clock::now() + kEnough;
  while (!fs::exists(file_) || fs::file_size(file_) < 50'000) {
    ASSERT_LT(std::chrono::steady_clock::now(), give_up) << recording.err() << run_.err();
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  recording.signal(SIGINT);
  EXPECT_EQ(recording.finish(kEnough).exit_code, 0);
  EXPECT_EQ(run_command({armature(), "info", file_, "--verify"}).exit_code, 0);
}

TEST_F(Recorded, AFullDiskIsToldAndEndsTheRecording) {
  const CommandResult result = run_command({armature(), "record", "-o", "/dev/full", "--domain",
                                            std::to_string(domain_), "--timeout", "20"},
                                           {}, kEnough);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "armature: cannot write '/dev/full': No space left on device\n");
}

TEST_F(Recorded, OnADiskThatFillsUpWhatStandsInTheFileIsCountedAndMadeWhole) {
  std::vector<std::string> command{"/bin/sh", "-c", "trap '' XFSZ; exec \"$@\"", "sh"};
  for (const std::string& word : record({})) command.push_back(word);
  Command recording{command};
  const auto give_up = std::chrono::steady_clock::now() + kEnough;
  while (!fs::exists(file_) || fs::file_size(file_) < 50'000) {
    ASSERT_LT(std::chrono::steady_clock::now(), give_up) << recording.err() << run_.err();
    std::this_thread::sleep_for(std::chrono::milliseconds{20});
  }
  const rlim_t full = fs::file_size(file_) + 20'000;
  const rlimit limit{.rlim_cur = full, .rlim_max = full};
  ASSERT_EQ(prlimit(recording.pid(), RLIMIT_FSIZE, &limit, nullptr), 0);
  const CommandResult result = recording.finish(kEnough);
  EXPECT_EQ(result.exit_code, 1);
  const std::string readable = std::to_string(all_messages(info(file_, 1)));
  EXPECT_THAT(result.err,
              ContainsRegex("armature: cannot write '" + file_ + "': File too large; " + readable +
                            " messages stand in the file and [1-9][0-9]* do not; those that do are "
                            "readable, and made whole by: armature record --repair"));
  EXPECT_THAT(result.err, Not(HasSubstr("came faster")));
  const std::string whole = folder_ / "whole.mcap";
  const CommandResult repaired =
      run_command({armature(), "record", "--repair", file_, "-o", whole});
  EXPECT_EQ(repaired.exit_code, 0) << repaired.err;
  EXPECT_EQ(std::to_string(all_messages(info(whole, 0))), readable);
}

TEST(RecordedFile, IsNotStandardOutput) {
  const CommandResult result = run_command({armature(), "record", "-o", "-", "--timeout", "1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("is written into a file only, not to standard output"));
}

TEST(RecordedFile, IsMadeOfOthersWithoutWhatIsOfADomain) {
  for (const char* of : {"--repair", "--merge"}) {
    for (const char* other : {"--json", "--uncompressed", "--no-shared-memory"}) {
      const CommandResult result =
          run_command({armature(), "record", "-o", "x.mcap", of, source_file("README.md"), other});
      EXPECT_EQ(result.exit_code, 2) << of << other << result.err;
    }
  }
}

TEST(Info, OfAPipeSaysThatItIsNoFileAndDoesNotWaitForItsWriter) {
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const CommandResult result = run_command({armature(), "info", pipe}, {}, kEnough);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("': it is no regular file"));
}

TEST(Info, OfADamagedFileTellsItsContentsBeforeWhatIsWrongWithIt) {
  const TemporaryFolder folder;
  const std::string cut = folder / "cut";
  {
    McapWriter writer{cut, {}};
    writer.add(McapMetadata{.name = "run", .values = {{"seed", "1"}}});
  }
  const CommandResult result =
      run_command({"/bin/sh", "-c", "'" + armature() + "' info '" + cut + "' 2>&1"});
  const std::size_t told = result.out.find(" chunks, "), wrong = result.out.find("is not whole");
  ASSERT_NE(wrong, std::string::npos) << result.out;
  EXPECT_LT(told, wrong) << result.out;
}

TEST(Info, OfWhatIsNoRecordingSaysSo) {
  const CommandResult result = run_command({armature(), "info", source_file("README.md")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("README.md' is no MCAP file"));
}

}  // namespace
}  // namespace armature::test
