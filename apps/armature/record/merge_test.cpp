// SPDX-License-Identifier: Apache-2.0
// The recordings of several processes are joined.
#include "record/merge.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "record/record_test.hpp"

namespace armature {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(JoinedRecording, HasTheMessagesOfAllInTheOrderOfTheirTimesAndTheRestOnce) {
  const RecordingFile a{"a"}, b{"b"}, out{"out"};
  write_part(a.path(), "main", 10);
  write_part(b.path(), "vision", 11);
  const JoinedRecording joined = join_recordings({a.path(), b.path()}, out.path());
  EXPECT_EQ(joined.messages, 200U);
  EXPECT_THAT(joined.problems, testing::IsEmpty());
  McapReader reader{out.path(), true};
  std::int64_t expected_ms = 10;
  std::map<std::string, std::uint32_t> sequences;
  while (const auto message = reader.next()) {
    EXPECT_EQ(message->log_time.ns, 1'000'000 * expected_ms++);
    EXPECT_EQ(message->sequence, sequences[message->channel->metadata.at("process")]++);
  }
  EXPECT_EQ(reader.chain().verdict, McapChain::Verdict::whole);
  EXPECT_EQ(reader.chain().head, joined.head);
  EXPECT_EQ(reader.attachments().size(), 1U);
  std::vector<std::string> names;
  for (const McapMetadata& metadata : reader.metadata()) names.push_back(metadata.name);
  EXPECT_THAT(names, testing::ElementsAre("armature.deployment", "armature.process",
                                          "armature.process", "armature.end", "armature.part",
                                          "armature.end", "armature.part"));
  EXPECT_EQ(reader.metadata().back().values.at("sha256"), sha256_of_file(b.path()));
  EXPECT_EQ(reader.metadata().back().values.at("chain"), "whole");
}

TEST(JoinedRecording, TakesThePlaceOfAPartAndSaysWhatWasCutOff) {
  const RecordingFile a{"a"}, b{"b"};
  write_part(a.path(), "main", 10);
  write_part(b.path(), "vision", 11);
  std::string bytes = b.bytes();
  bytes.resize(places_of(mcap::Op::chunk, bytes).at(3));
  b.replace(bytes);
  const JoinedRecording joined = join_recordings({a.path(), b.path()}, a.path());
  ASSERT_EQ(joined.problems.size(), 1U);
  EXPECT_THAT(joined.problems[0], HasSubstr(b.path().string() + "': it ends before its summary"));
  EXPECT_GT(joined.messages, 100U);
  McapReader reader{a.path(), true};
  while (reader.next()) continue;
  EXPECT_EQ(reader.chain().verdict, McapChain::Verdict::whole);
  EXPECT_EQ(reader.metadata().back().values.at("chain"), "cut");
  EXPECT_THAT(reader.metadata().back().values.at("first_problem"), HasSubstr("it ends before"));
}

TEST(JoinedRecording, IsNotCalledCompleteWhenAPartWasCutOffOrChanged) {
  const RecordingFile a{"a"}, b{"b"}, out{"out"};
  write_part(a.path(), "main", 10);
  write_part(b.path(), "vision", 11);
  const std::string whole = b.bytes();
  const auto told = [&](bool verify) {
    join_recordings({a.path(), b.path()}, out.path());
    return info_text({.file = out.path(), .verify = verify}, kOk);
  };
  EXPECT_THAT(told(false), Not(HasSubstr("incomplete")));
  std::string changed = whole;
  changed[places_of(mcap::Op::chunk, whole).at(1) + 60] ^= 0x01;
  const std::string cut = whole.substr(0, places_of(mcap::Op::chunk, whole).at(3));
  const std::map<std::string, std::string> words{{changed, "changed after it was written"},
                                                 {cut, "cut off"}};
  for (const auto& [bytes, word] : words) {
    b.replace(bytes);
    for (const bool verify : {false, true}) {
      EXPECT_THAT(told(verify),
                  HasSubstr("incomplete: the part of process 'vision' was " + word + ": "));
      const nlohmann::json info = info_of(out.path(), verify);
      ASSERT_EQ(info["repaired"].size(), 1U) << info.dump(1);
    }
  }
}

TEST(JoinedRecording, IsNotMadeOfWhatIsNotOneRunAndLeavesEverythingAsItWas) {
  const RecordingFile a{"a"}, b{"b"};
  const auto reason = [&] {
    try {
      join_recordings({a.path(), b.path()}, a.path());
      return std::string{};
    } catch (const InvalidChoice& refusal) {
      return std::string{refusal.what()};
    }
  };
  write_part(a.path(), "main", 10);
  const std::string before = a.bytes();
  write_part(b.path(), "vision", 11, "2");
  EXPECT_THAT(reason(), HasSubstr("are of different runs"));
  write_part(b.path(), "main", 11);
  EXPECT_THAT(reason(), HasSubstr("are both of process 'main'"));
  {
    McapWriter writer{b.path(), {}};
    write_all_but_the_end(writer, 10);
    writer.close();
  }
  EXPECT_THAT(reason(), HasSubstr("is no part of a run"));
  EXPECT_EQ(a.bytes(), before);
  for (const auto& entry : std::filesystem::directory_iterator{a.path().parent_path()}) {
    EXPECT_FALSE(entry.path().string().starts_with(a.path().string() + ".joining"));
  }
}

TEST(JoinedRecording, MayHaveBeenJoinedBeforeAndHasNoProcessTwice) {
  const RecordingFile a{"a"}, b{"b"}, c{"c"}, joined{"joined"}, all{"all"};
  write_part(a.path(), "main", 10);
  write_part(b.path(), "vision", 11);
  write_part(c.path(), "desk", 12);
  join_recordings({a.path(), b.path()}, joined.path());
  const JoinedRecording whole = join_recordings({joined.path(), c.path()}, all.path());
  EXPECT_EQ(whole.messages, 300U);
  EXPECT_EQ(whole.processes, 3U);
  McapReader reader{all.path()};
  while (reader.next()) continue;
  std::map<std::string, std::string> last_file;  // of the parts with a process
  for (const McapMetadata& metadata : reader.metadata()) {
    if (metadata.name == "armature.part") {
      last_file[metadata.values.at("process")] = metadata.values.at("file");
    }
  }
  EXPECT_EQ(last_file.at("main"), joined.path().filename().string());
  EXPECT_EQ(last_file.at("vision"), joined.path().filename().string());
  EXPECT_EQ(last_file.at("desk"), c.path().filename().string());
  for (const RecordingFile* again : {&a, &b}) {
    EXPECT_THROW(join_recordings({joined.path(), again->path()}, all.path()), InvalidChoice);
  }
}

TEST(JoinedRecording, IsForItsUserAloneAndFollowsNoLink) {
  const RecordingFile a{"a"}, b{"b"}, victim{"victim"};
  write_part(a.path(), "main", 10);
  write_part(b.path(), "vision", 11);
  victim.replace("not ours");
  const std::string draft = a.path().string() + ".joining";  // as a draft might be called
  std::filesystem::create_symlink(victim.path(), draft);
  join_recordings({a.path(), b.path()}, a.path());
  std::filesystem::remove(draft);
  EXPECT_EQ(victim.bytes(), "not ours");
  EXPECT_FALSE(std::filesystem::is_symlink(a.path()));
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(a.path()).permissions(),
            perms::owner_read | perms::owner_write);
}

}  // namespace
}  // namespace armature
