// SPDX-License-Identifier: Apache-2.0
#include "bench/turns.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace armature::bench {
namespace {

constexpr std::size_t kBlock = 50;  // items of one contestant in one go

}  // namespace

void take_turns(
    const Turns& turns,
    const std::function<void(std::size_t contestant, std::size_t from, std::size_t to)>& go) {
  std::mt19937_64 random{turns.order};
  std::vector<std::size_t> order(turns.contestants), blocks;
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t from = 0; from < turns.items; from += kBlock) blocks.push_back(from);
  const double work = static_cast<double>(blocks.size()) * turns.repetitions;
  double done = 0;
  for (int repetition = 0; repetition < turns.repetitions; ++repetition) {
    std::ranges::shuffle(blocks, random);
    for (const std::size_t from : blocks) {
      std::ranges::shuffle(order, random);
      for (const std::size_t k : order) go(k, from, std::min(from + kBlock, turns.items));
      if (turns.progress) turns.progress(++done / work);
    }
  }
}

}  // namespace armature::bench
