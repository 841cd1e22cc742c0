// SPDX-License-Identifier: Apache-2.0
// `armature record --repair` keeps what is left of a damaged recording, and replaces no device.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <chrono>
#include <cstddef>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/values/file_content.hpp"
#include "armature/values/temporary_folder.hpp"
#include "exit_code.hpp"
#include "record/destination.hpp"
#include "record/merge.hpp"
#include "record/record_test.hpp"

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

TEST(ANameForARecording, ThatIsTooLongIsToldByWhatWritesIt) {
  const std::string name = "/tmp/" + std::string(300, 'y');
  const auto write = [&] {
    const Destination destination{name, true};
    const McapWriter writer{destination.path(), {}};
  };
  EXPECT_THAT(write, testing::ThrowsMessage<std::runtime_error>("cannot write '" + name +
                                                                "': File name too long"));
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
  EXPECT_THAT(told,
              HasSubstr("--repair '" + folder + "/the patient'\\''s $HOME.mcap' -o whole.mcap"));
}

TEST(DamagedRecording, WhoseNamesATerminalWouldObeyIsRepairedWithoutThat) {
  const RecordingFile file{"obeyed"}, repaired{"repaired"};
  const std::string no_map = RawMcap::number(std::uint32_t{0});
  file.replace(RawMcap::file(RawMcap::chunk(
      5, 7,
      RawMcap::schema(1) + RawMcap::channel(2, 1, no_map, "/\033[31m") + RawMcap::message(2, 9))));
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(repair_recording(file.path(), repaired.path(), true), kOk);
  testing::internal::GetCapturedStdout();
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_THAT(told, HasSubstr("of '/\\x1b[31m', has the log time 9 ns"));
  EXPECT_THAT(told, Not(HasSubstr("\033")));
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

}  // namespace
}  // namespace armature
