// SPDX-License-Identifier: Apache-2.0
#include "replay/recorded_run.hpp"

#include <gmock/gmock.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/recording/hash_chain.hpp"
#include "armature/recording/mcap_writer.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/recording/recording_test.hpp"
#include "armature/runtime/recording/recorded_description.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature {
namespace {

constexpr std::uint32_t kWriter = 7, kSamples = 100;

/// Records `count` samples of an input at their times, and then a call that began with the first.
void write_call(const std::filesystem::path& file, const std::function<Time(std::uint32_t)>& at,
                std::uint32_t count) {
  McapWriter writer{file, {}};
  writer.add(McapMetadata{.name = std::string{kDeploymentMetadata},
                          .values = {{"deployment", "lamp"}, {"run", "1"}}});
  writer.add(McapMetadata{.name = std::string{kComponentMetadata},
                          .values = {{"component", "planner"}, {kProcessKey, "main"}}});
  const auto channel = [&](const std::string& topic, const MessageType& type) {
    return writer.add(McapChannel{.topic = topic,
                                  .message_encoding = "cdr",
                                  .metadata = {{"dds_type", std::string{type.dds_name}},
                                               {"writer", std::to_string(kWriter)},
                                               {kProcessKey, "main"}}});
  };
  const auto samples = channel("/lamp/state", message_type<msg::Capture>());
  const auto activations = channel("/lamp/activations", message_type<msg::Activation>());
  const std::vector<std::byte> sample(16);
  for (std::uint32_t i = 1; i <= count; ++i) writer.write(samples, i, at(i), at(i), sample);
  msg::Activation call;
  call.component_("planner");
  set_stamp(call.now_(), at(1));
  std::vector<std::byte> cdr;
  message_type<msg::Activation>().encode(&call, cdr);
  writer.write(activations, 1, at(1), Time{}, cdr);
  writer.close();
}

/// The input comes ten times a second, and the call lasts from its first sample to its last.
void write_long_call(const std::filesystem::path& file) {
  write_call(
      file, [](std::uint32_t sample) { return Time{} + seconds(0.1 * sample); }, kSamples);
}

TEST(RecordedRun, HoldsWhatALongCallHasReadUntilTheCallIsTold) {
  const TemporaryFolder folder;
  write_long_call(folder / "run.mcap");
  RecordedRun run{folder / "run.mcap", "main"};
  run.keep_for_call(seconds(10));
  ASSERT_TRUE(run.next());
  EXPECT_TRUE(run.sample(kWriter, 1));
  EXPECT_TRUE(run.sample(kWriter, kSamples));
}

TEST(RecordedRun, HoldsWhatHasWaitedForItsReaderWhileNothingElseCame) {
  const TemporaryFolder folder;
  constexpr std::uint32_t kBurst = 20;  // more than are held whatever their time
  write_call(
      folder / "run.mcap",
      [](std::uint32_t sample) {
        return Time{} + (sample == 1 ? Duration{0} : seconds(60 + 0.001 * sample));
      },
      kBurst);
  RecordedRun run{folder / "run.mcap", "main"};
  ASSERT_TRUE(run.next());
  EXPECT_TRUE(run.sample(kWriter, 1)) << "a call that began before the burst has read it";
}

TEST(RecordedRun, HoldsNoMoreThanTheCallsOfItsComponentsNeed) {
  const TemporaryFolder folder;
  write_long_call(folder / "run.mcap");
  RecordedRun run{folder / "run.mcap", "main"};
  ASSERT_TRUE(run.next());
  EXPECT_FALSE(run.sample(kWriter, 1));
  EXPECT_TRUE(run.sample(kWriter, kSamples));
}

TEST(RecordedRun, ThatWasChangedAfterItWasWrittenSaysSoThoughNoChecksumTells) {
  const RecordingFile file{"changed"};
  write_long_call(file.path());
  const auto problems = [&] {
    RecordedRun run{file.path(), "main"};
    while (run.next()) continue;
    return run.problems();
  };
  const auto told = [](const std::string& where) {
    return testing::Contains(
        testing::StartsWith("it was changed after it was written: " + where + ", within"));
  };
  EXPECT_THAT(problems(), testing::Not(told("chunk 1")));
  std::string bytes = file.bytes();
  constexpr std::size_t kHead = 9, kChecksumOfChunk = kHead + 24, kChecksumBytes = 4;
  // Zero stands for none, as some programs write it.
  bytes.replace(places_of(mcap::Op::chunk, bytes).front() + kChecksumOfChunk, kChecksumBytes,
                kChecksumBytes, '\0');
  bytes.replace(places_of(mcap::Op::data_end, bytes).front() + kHead, kChecksumBytes,
                kChecksumBytes, '\0');
  file.replace(bytes);
  EXPECT_THAT(problems(), testing::AllOf(told("chunk 1"), told("the summary")));
  constexpr auto kLink = static_cast<mcap::Op>(ChainRecord::kOp);
  for (auto links = places_of(kLink, bytes); !links.empty(); links.pop_back()) {
    std::uint64_t size = 0;
    std::memcpy(&size, &bytes[links.back() + 1], sizeof size);
    bytes.erase(links.back(), kHead + size);
  }
  file.replace(bytes);
  EXPECT_THAT(problems(), testing::Contains("its chain of hashes is gone: whether it was changed "
                                            "cannot be told"));
}

}  // namespace
}  // namespace armature
