// SPDX-License-Identifier: Apache-2.0
// The state of a plugin: 1. it holds nothing at first, 2. it comes back as it was set, in copies
// too,
// 3. in another layout it is nothing.
#include "armature/values/plugin_state.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

struct Mean {
  static constexpr auto kLayout = layout_id("target/mean", 1);
  std::array<double, 3> mean{};
  int count = 0;
};
struct LaterMean : Mean {
  static constexpr auto kLayout = layout_id("target/mean", 2);
};
struct MeanOfAnother : Mean {
  static constexpr auto kLayout = layout_id("target/other", 1);
};

TEST(PluginState, RemembersNothingAtFirst) {
  const PluginState state;
  EXPECT_TRUE(state.empty());
  EXPECT_EQ(state.get<Mean>(), nullptr);
}

TEST(PluginState, GivesBackWhatWasSetAndSoDoesACopy) {
  PluginState state;
  state.set(Mean{{1, 2, 3}, 4});
  const PluginState copy = state;
  state.set(Mean{{5, 6, 7}, 8});
  ASSERT_NE(copy.get<Mean>(), nullptr);
  EXPECT_EQ(copy.get<Mean>()->mean, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(copy.get<Mean>()->count, 4);
  EXPECT_EQ(state.get<Mean>()->count, 8);
  state = {};
  EXPECT_TRUE(state.empty());
}

TEST(PluginState, OfAnotherPluginOrVersionIsNothing) {
  PluginState state;
  state.set(Mean{});
  EXPECT_FALSE(state.empty());
  EXPECT_EQ(state.get<LaterMean>(), nullptr);
  EXPECT_EQ(state.get<MeanOfAnother>(), nullptr);
}

}  // namespace
}  // namespace armature
