// SPDX-License-Identifier: Apache-2.0
#include "replay/recorded_run.hpp"

#include <gmock/gmock.h>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/recording/mcap_writer.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/recording/recording_test.hpp"
#include "armature/runtime/recording/recorded_description.hpp"
#include "armature/values/temporary_folder.hpp"

namespace armature {
namespace {

constexpr std::uint32_t kWriter = 7, kSamples = 100;

/// Records an input ten times a second, and one call that lasts from its first sample to its last.
void write_long_call(const std::filesystem::path& file) {
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
  for (std::uint32_t i = 1; i <= kSamples; ++i) {
    const Time at = Time{} + seconds(0.1 * i);
    writer.write(samples, i, at, at, sample);
  }
  msg::Activation call;
  call.component_("planner");
  set_stamp(call.now_(), Time{} + seconds(0.1));
  std::vector<std::byte> cdr;
  message_type<msg::Activation>().encode(&call, cdr);
  writer.write(activations, 1, Time{} + seconds(0.1), Time{}, cdr);
  writer.close();
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
}

}  // namespace
}  // namespace armature
