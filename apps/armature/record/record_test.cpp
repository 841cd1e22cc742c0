// SPDX-License-Identifier: Apache-2.0
// What `armature info` and `armature record --repair` do with files that were damaged at random.
#include "record/record.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <random>
#include <stdexcept>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/recording_test.hpp"
#include "exit_code.hpp"

namespace armature {
namespace {

using testing::HasSubstr;

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

}  // namespace
}  // namespace armature
