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

/// range(0): bytes of a message; range(1): whether it is packed. Half of its bytes are random.
void write_messages(benchmark::State& state) {
  const auto file = std::filesystem::path{"/dev/shm"} /
                    ("armature-kernels-" + std::to_string(getpid()) + ".mcap");
  std::mt19937 random{1};
  std::vector<std::byte> message(static_cast<std::size_t>(state.range(0)));
  for (std::size_t i = 0; i < message.size(); i += 2) message[i] = static_cast<std::byte>(random());
  std::uint32_t count = 0;
  {
    McapWriter writer{file, {.compress = state.range(1) != 0}};
    const auto schema = writer.add(McapSchema{.name = "a/msg/B", .encoding = "ros2msg"});
    const auto channel =
        writer.add(McapChannel{.schema_id = schema, .topic = "/b", .message_encoding = "cdr"});
    for (auto _ : state) {
      writer.write(channel, count, Time{count}, Time{count}, message);
      // The file begins again before the memory is full.
      if (writer.bytes() > (std::uint64_t{256} << 20)) std::filesystem::resize_file(file, 0);
      ++count;
    }
  }
  std::filesystem::remove(file);
  state.SetItemsProcessed(state.iterations());
  state.SetBytesProcessed(state.iterations() * state.range(0));
}

BENCHMARK(write_messages)
    ->Name("recording")
    ->ArgNames({"bytes", "zstd"})
    ->ArgsProduct({{64, 921'664}, {0, 1}});

}  // namespace
}  // namespace armature
