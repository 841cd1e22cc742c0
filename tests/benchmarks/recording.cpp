// SPDX-License-Identifier: Apache-2.0
// How fast messages go into a recording, on a disk of memory.
// --benchmark_filter=recording
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "armature/recording/mcap_writer.hpp"

namespace armature {
namespace {

/// range(0): bytes of a message; range(1): whether it is packed; range(2): whether it is in a chain
/// of hashes. Half of its bytes are random, and
/// no two messages are the same.
void write_messages(benchmark::State& state) {
  const auto file = std::filesystem::path{"/dev/shm"} /
                    ("armature-kernels-" + std::to_string(getpid()) + ".mcap");
  std::mt19937 random{1};
  const auto size = static_cast<std::size_t>(state.range(0));
  constexpr std::size_t kSource = std::size_t{64}
                                  << 20;  // messages begin at different places of it
  std::vector<std::byte> source(kSource + size);
  for (std::size_t i = 0; i < source.size(); i += 2) source[i] = static_cast<std::byte>(random());
  constexpr std::uint64_t kMostKept = std::uint64_t{256} << 20;
  std::uint64_t emptied = 0;
  std::uint32_t count = 0;
  {
    McapWriter writer{file, {.compress = state.range(1) != 0, .chain = state.range(2) != 0}};
    const auto schema = writer.add(McapSchema{.name = "a/msg/B", .encoding = "ros2msg"});
    const auto channel =
        writer.add(McapChannel{.schema_id = schema, .topic = "/b", .message_encoding = "cdr"});
    for (auto _ : state) {
      const std::size_t begin = (count * std::size_t{7919} * 64) % kSource;
      writer.write(channel, count, Time{count}, Time{count},
                   std::span{source}.subspan(begin, size));
      ++count;
      if (writer.bytes() < emptied + kMostKept) continue;
      emptied = writer.bytes();  // the file gives its memory back, and goes on behind it
      std::filesystem::resize_file(file, 0);
    }
  }
  std::filesystem::remove(file);
  state.SetItemsProcessed(state.iterations());
  state.SetBytesProcessed(state.iterations() * state.range(0));
}

BENCHMARK(write_messages)
    ->Name("recording")
    ->ArgNames({"bytes", "zstd", "chain"})
    ->ArgsProduct({{64, 921'664}, {0, 1}, {0, 1}});

}  // namespace
}  // namespace armature
