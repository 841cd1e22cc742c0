// SPDX-License-Identifier: Apache-2.0
// What `armature info` and `armature record --repair` do with files that were damaged at random,
// and
// `--merge` with the files of a run.
#include "record/record.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/recording/recording_test.hpp"
#include "armature/runtime/recording/recorded_description.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "exit_code.hpp"
#include "record/destination.hpp"
#include "record/merge.hpp"

namespace armature {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Runs `work` and hides what it prints.
template <class Work>
int in_silence(const Work& work) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  int code = kFailed;
  try {
    code = work();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("is packed with 'lz4'"));
  }
  testing::internal::GetCapturedStdout();
  testing::internal::GetCapturedStderr();
  return code;
}

McapChain chain_of(const std::filesystem::path& file) {
  McapReader reader{file, true};
  while (reader.next()) continue;
  return reader.chain();
}

/// A recording as a process leaves it: so many messages, one a millisecond from `first_ms` on.
void write_part(const std::filesystem::path& file, const std::string& process, int first_ms,
                const std::string& run = "1") {
  McapWriter writer{file, {.chunk_bytes = 1024}};
  writer.attach(
      {.name = "lamp/lamp.yaml", .media_type = "application/yaml", .data = "armature: 1"});
  writer.add(McapMetadata{.name = "armature.deployment",
                          .values = {{"deployment", "lamp"}, {"run", run}}});
  writer.add(McapMetadata{.name = "armature.process", .values = {{"process", process}}});
  const auto schema = writer.add(
      McapSchema{.name = "std_msgs/msg/String", .encoding = "ros2msg", .data = "string data\n"});
  const auto channel = writer.add(McapChannel{.schema_id = schema,
                                              .topic = "/a",
                                              .message_encoding = "cdr",
                                              .metadata = {{"process", process}}});
  for (int i = 0; i < 100; ++i) {
    const std::string text = payload(i);
    const Time time{1'000'000 * (first_ms + 2 * i)};
    writer.write(channel, static_cast<std::uint32_t>(i), time, time,
                 std::as_bytes(std::span{text}));
  }
  writer.add(McapMetadata{.name = "armature.end", .values = {{"process", process}}});
  writer.close();
}

TEST(DamagedRecording, IsToldOfAndRepairedToOneWithAChainOfItsOwn) {
  const RecordingFile file{"damaged"}, repaired{"repaired"};
  {
    McapWriter writer{file.path(), {.chunk_bytes = 1024}};
    write_all_but_the_end(writer, 100);
    writer.close();
  }
  const std::string whole = file.bytes();
  const Seed seed;
  std::mt19937 random = seed.generator();
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds{2};
  while (std::chrono::steady_clock::now() < end) {
    std::string bytes = whole;
    for (int i = 0; i < 4; ++i) {
      const std::size_t at = 8 + random() % (bytes.size() - 8);
      bytes[at] = static_cast<char>(bytes[at] ^ (1 + random() % 255));
    }
    if (random() % 4 == 0) bytes.resize(8 + random() % (bytes.size() - 8));
    if (bytes == whole) continue;
    file.replace(bytes);
    for (const bool json : {false, true}) {
      const InfoOptions info{.file = file.path(), .json = json, .verify = true};
      EXPECT_EQ(in_silence([&] { return describe_recording(info); }), kFailed);
    }
    if (in_silence([&] { return repair_recording(file.path(), repaired.path(), true); }) == kOk) {
      EXPECT_EQ(chain_of(repaired.path()).verdict, McapChain::Verdict::whole);
    }
  }
}

TEST(DamagedRecording, IsNamedInTheOneThatWasMadeOfIt) {
  const RecordingFile file{"damaged"}, repaired{"repaired"};
  {
    McapWriter writer{file.path(), {.chunk_bytes = 1024}};
    write_all_but_the_end(writer, 100);
    writer.close();
  }
  std::string bytes = file.bytes();
  bytes[places_of(mcap::Op::chunk, bytes).at(2) + 60] ^= 0x01;
  file.replace(bytes);
  ASSERT_EQ(in_silence([&] { return repair_recording(file.path(), repaired.path(), true); }), kOk);
  McapReader reader{repaired.path()};
  while (reader.next()) continue;
  ASSERT_EQ(reader.metadata().back().name, "armature.repaired");
  const auto& told = reader.metadata().back().values;
  EXPECT_EQ(told.at("file"), file.path().filename().string());
  EXPECT_EQ(told.at("chain"), "changed");
  EXPECT_EQ(told.at("chain_head"), chain_of(file.path()).head);
  EXPECT_EQ(told.at("sha256"), sha256_of_file(file.path()));
}

TEST(DamagedRecording, OnAFullDiskIsNotRepairedAtTheCostOfTheFileThatWasThere) {
  const RecordingFile file{"damaged"}, older{"older"};
  {
    McapWriter writer{file.path(), {.compress = false, .chunk_bytes = 1024}};
    write_all_but_the_end(writer, 1000);
  }
  older.replace("an older recording");
  {
    const FileSizeLimit limit{4096};
    EXPECT_THROW(repair_recording(file.path(), older.path(), true), std::runtime_error);
  }
  EXPECT_EQ(older.bytes(), "an older recording");
  for (const auto& entry : std::filesystem::directory_iterator{older.path().parent_path()}) {
    EXPECT_FALSE(entry.path().string().starts_with(older.path().string() + ".")) << entry.path();
  }
}

TEST(ANameForARecording, ThatIsAPipeStaysOne) {
  const RecordingFile part{"part"};
  const TemporaryFolder folder;
  const std::filesystem::path pipe = folder / "pipe.mcap";
  write_part(part.path(), "main", 10);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto says = testing::ThrowsMessage<std::runtime_error>("cannot write '" + pipe.string() +
                                                               "': it is no regular file");
  EXPECT_THAT([&] { repair_recording(part.path(), pipe, true); }, says);
  EXPECT_THAT([&] { merge_recordings({part.path()}, pipe, true); }, says);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(ANameForARecording, ThatIsALinkKeepsPointing) {
  const RecordingFile part{"part"};
  write_part(part.path(), "main", 10);
  const std::map<std::string, std::function<void(const std::filesystem::path&)>> writers{
      {"repair", [&](const auto& out) { repair_recording(part.path(), out, true); }},
      {"merge", [&](const auto& out) { merge_recordings({part.path()}, out, true); }},
      {"record", [](const auto& out) {
         Destination destination{out, true};
         std::ofstream{destination.path()} << "newer";
         destination.take();
       }}};
  for (const auto& [name, write] : writers) {
    const TemporaryFolder folder;
    const std::filesystem::path link = folder / "link.mcap", older = folder / "older.mcap";
    std::ofstream{older} << "older";
    std::filesystem::create_symlink("older.mcap", link);
    write(link);
    EXPECT_TRUE(std::filesystem::is_symlink(link)) << name;
    EXPECT_NE(content_of(older), "older") << name;
  }
}

TEST(ARecordingThatIsBeingWritten, IsReplacedByNobody) {
  const RecordingFile file{"damaged"}, written{"written"};
  {
    McapWriter writer{file.path(), {}};
    write_all_but_the_end(writer, 10);
  }
  McapWriter writer{written.path(), {.chunk_bytes = 64}};
  write_all_but_the_end(writer, 10);
  const std::string before = written.bytes();
  ASSERT_FALSE(before.empty());
  const auto says = testing::ThrowsMessage<std::runtime_error>(
      HasSubstr("written.mcap' is being written by another program"));
  EXPECT_THAT([&] { repair_recording(file.path(), written.path(), true); }, says);
  EXPECT_THAT([&] { merge_recordings({file.path()}, written.path(), true); }, says);
  EXPECT_EQ(written.bytes(), before);
}

/// The text that `info` prints: results and complaints.
std::string info_text(const InfoOptions& info, int exit_code) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(describe_recording(info), exit_code);
  const std::string out = testing::internal::GetCapturedStdout();
  return out + testing::internal::GetCapturedStderr();
}

/// The object that `armature info --json` prints.
nlohmann::json info_of(const std::filesystem::path& file, bool verify) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(describe_recording({.file = file, .json = true, .verify = verify}), kOk);
  return nlohmann::json::parse(testing::internal::GetCapturedStdout());
}

TEST(DamagedRecording, IsToldOfByInfoAlsoWhenItWasRepaired) {
  const RecordingFile file{"damaged"}, repaired{"repaired"};
  {
    McapWriter writer{file.path(), {.chunk_bytes = 1024}};
    write_all_but_the_end(writer, 100);
    writer.close();
  }
  const std::string whole = file.bytes();
  ASSERT_EQ(in_silence([&] { return repair_recording(file.path(), repaired.path(), true); }), kOk);
  EXPECT_THAT(info_text({.file = repaired.path(), .verify = true}, kOk),
              Not(HasSubstr("incomplete")))
      << "nothing was missing";
  file.replace(whole.substr(0, places_of(mcap::Op::chunk, whole).at(3)));
  ASSERT_EQ(in_silence([&] { return repair_recording(file.path(), repaired.path(), true); }), kOk);
  const std::string expected = "incomplete: it was repaired from '" +
                               file.path().filename().string() + "', which was cut off";
  for (const bool verify : {false, true}) {
    EXPECT_THAT(info_text({.file = repaired.path(), .verify = verify}, kOk), HasSubstr(expected));
  }
}

TEST(DamagedRecording, OfAProcessIsJoinedAfterItWasRepairedAndIsSeenThere) {
  const RecordingFile cut{"part"}, repaired{"repaired"}, main{"main"}, joined{"joined"};
  const RecordingFile twice{"twice"};
  write_part(main.path(), "main", 10);
  write_part(cut.path(), "vision", 11);
  const std::string whole = cut.bytes();
  cut.replace(whole.substr(0, places_of(mcap::Op::chunk, whole).at(3)));
  ASSERT_EQ(in_silence([&] { return repair_recording(cut.path(), repaired.path(), true); }), kOk);
  EXPECT_EQ(recorded_processes(repaired.path()), std::vector<std::string>{"vision"});
  ASSERT_EQ(in_silence([&] {
              return merge_recordings({main.path(), repaired.path()}, joined.path(), true);
            }),
            kOk);
  EXPECT_THAT(recorded_processes(joined.path()), testing::ElementsAre("main", "vision"));
  EXPECT_THAT(
      [&] {
        merge_recordings({joined.path(), repaired.path()}, twice.path(), true);
      },
      testing::ThrowsMessage<InvalidChoice>(HasSubstr("are both of process 'vision'")));
}

TEST(DamagedRecording, HasWhatItsProcessSaidOfItselfWhereItStood) {
  const RecordingFile cut{"part"}, repaired{"repaired"};
  write_part(cut.path(), "vision", 11);
  ASSERT_EQ(in_silence([&] { return repair_recording(cut.path(), repaired.path(), true); }), kOk);
  McapReader reader{repaired.path()};
  ASSERT_TRUE(reader.next());
  EXPECT_EQ(processes_of(reader.metadata()), std::vector<std::string>{"vision"});
  EXPECT_EQ(reader.attachments().size(), 1U);
  while (reader.next()) continue;
  EXPECT_EQ(reader.attachments().size(), 1U);
  std::vector<std::string> names;
  for (const McapMetadata& metadata : reader.metadata()) names.push_back(metadata.name);
  EXPECT_THAT(names, testing::ElementsAre("armature.deployment", "armature.process", "armature.end",
                                          "armature.repaired"));
}

/// Writes a part as older versions repaired it: what its process said of itself stands behind
/// everything.
void write_part_repaired_before(const std::filesystem::path& file, const std::string& process) {
  McapWriter writer{file, {.chunk_bytes = 1024}};
  write_all_but_the_end(writer, 100);
  writer.add(McapMetadata{.name = "armature.deployment",
                          .values = {{"deployment", "lamp"}, {"run", "1"}}});
  writer.add(McapMetadata{.name = "armature.process", .values = {{"process", process}}});
  writer.close();
}

TEST(DamagedRecording, ThatWasRepairedByAnOlderVersionIsSeenWhereItWasJoined) {
  const RecordingFile old{"old"}, main{"main"}, joined{"joined"};
  write_part(main.path(), "main", 10);
  write_part_repaired_before(old.path(), "vision");
  join_recordings({main.path(), old.path()}, joined.path());
  EXPECT_THAT(recorded_processes(joined.path()), testing::ElementsAre("main", "vision"));
}

TEST(DamagedRecording, WithAnyNameIsRepairedByTheLineThatIsTold) {
  const RecordingFile file{"the patient's $HOME"};
  {
    McapWriter writer{file.path(), {.chunk_bytes = 1024}};
    write_all_but_the_end(writer, 100);
  }
  const std::string told = info_text({.file = file.path()}, kFailed);
  const std::string folder = file.path().parent_path();
  EXPECT_THAT(told, HasSubstr("--repair '" + folder + "/armature-"));
  EXPECT_THAT(told, HasSubstr("-the patient'\\''s $HOME.mcap' -o whole.mcap"));
}

TEST(DamagedRecording, OfWhichNothingIsLeftIsNotSentToBeRepaired) {
  const RecordingFile file{"damaged"};
  {
    McapWriter writer{file.path(), {.chunk_bytes = 1024}};
    write_all_but_the_end(writer, 100);
    writer.close();
  }
  const std::string whole = file.bytes();
  for (const std::size_t bytes : {std::size_t{8}, std::size_t{30}}) {
    file.replace(whole.substr(0, bytes));
    for (const bool verify : {false, true}) {
      const std::string told = info_text({.file = file.path(), .verify = verify}, kFailed);
      EXPECT_THAT(told, HasSubstr("nothing can be read of it")) << bytes << " bytes";
      EXPECT_THAT(told, Not(HasSubstr("--repair"))) << bytes << " bytes";
      EXPECT_THAT(told, Not(HasSubstr("0.000 s by"))) << bytes << " bytes";
    }
  }
}

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

TEST(Info, CountsAMessageOnceThatItsWriterAndAReaderHaveRecorded) {
  const RecordingFile file{"info"};
  {
    McapWriter writer{file.path(), {.chunk_bytes = 1024}};
    for (const char* process : {"main", "vision"}) {
      writer.add(McapMetadata{.name = "armature.process", .values = {{"process", process}}});
    }
    const auto schema = writer.add(
        McapSchema{.name = "std_msgs/msg/String", .encoding = "ros2msg", .data = "string data\n"});
    const auto channel_of = [&](std::map<std::string, std::string> metadata) {
      return writer.add(McapChannel{.schema_id = schema,
                                    .topic = "/a",
                                    .message_encoding = "cdr",
                                    .metadata = std::move(metadata)});
    };
    const std::vector<std::pair<std::uint16_t, int>> counts{
        {channel_of({{"process", "vision"}}), 100},
        {channel_of({{"process", "main"}, {"from", "vision"}}), 40},
        {channel_of({{"process", "main"}, {"from", "vision,desk"}}), 7}};  // desk is not in it
    for (const auto& [channel, count] : counts) {
      for (int i = 0; i < count; ++i) {
        const std::string text = payload(1);
        const Time time{10'000'000 * (i + 1)};
        writer.write(channel, static_cast<std::uint32_t>(i), time, time,
                     std::as_bytes(std::span{text}));
      }
    }
    writer.close();
  }
  for (const bool verify : {false, true}) {
    const nlohmann::json info = info_of(file.path(), verify);
    EXPECT_EQ(info["doubled"], 40) << info.dump(1);
    ASSERT_EQ(info["topics"].size(), 1U);
    EXPECT_EQ(info["topics"][0]["messages"], 107);
    EXPECT_EQ(info["topics"][0]["doubled"], 40);
    if (!verify) continue;
    EXPECT_EQ(info["topics"][0]["bytes"], 107 * payload(1).size());
  }
}

TEST(Info, TellsATopicThatHasTwoTypesOnceForEach) {
  const RecordingFile file{"info"};
  {
    McapWriter writer{file.path(), {.chunk_bytes = 1024}};
    int messages = 0;
    for (const char* type : {"std_msgs/msg/Float64", "std_msgs/msg/String"}) {
      const auto schema =
          writer.add(McapSchema{.name = type, .encoding = "ros2msg", .data = "# as there\n"});
      const auto channel =
          writer.add(McapChannel{.schema_id = schema, .topic = "/a", .message_encoding = "cdr"});
      messages += 10;
      for (int i = 0; i < messages; ++i) {
        const std::string text = payload(1);
        writer.write(channel, static_cast<std::uint32_t>(i), Time{i}, Time{i},
                     std::as_bytes(std::span{text}));
      }
    }
    writer.close();
  }
  for (const bool verify : {false, true}) {
    const nlohmann::json topics = info_of(file.path(), verify)["topics"];
    ASSERT_EQ(topics.size(), 2U) << topics.dump(1);
    EXPECT_EQ(topics[0]["type"], "std_msgs/msg/Float64");
    EXPECT_EQ(topics[0]["messages"], 10);
    EXPECT_EQ(topics[1]["topic"], "/a");
    EXPECT_EQ(topics[1]["messages"], 20);
  }
}

TEST(Info, SaysThatAFileIsWholeAndHowOftenATopicCameOnlyWhenItHasReadAllOfIt) {
  const RecordingFile file{"info"};
  write_part(file.path(), "main", 10);
  std::string bytes = file.bytes();
  EXPECT_EQ(info_of(file.path(), true)["whole"], true);
  EXPECT_THAT(info_text({.file = file.path(), .verify = true}, kOk), HasSubstr("500.0 Hz"));
  EXPECT_THAT(info_text({.file = file.path()}, kOk), Not(HasSubstr("Hz")));
  bytes[places_of(mcap::Op::chunk, bytes).at(1) + 60] ^= 0x01;
  file.replace(bytes);
  EXPECT_EQ(info_of(file.path(), false)["whole"], nlohmann::json{}) << "nobody has looked";
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
