// SPDX-License-Identifier: Apache-2.0
// A component whose device makes its reader wait: what the thread reads comes to `step` with its
// own stamps, in order, and nobody waits for anybody.
#include "armature/runtime/component/driver_thread.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <semaphore>
#include <stdexcept>

#include "armature/runtime/testing/component_harness.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kReaderManifest = R"({armature_plugin: 1, id: test/reader, kind: component)";

/// A device that a test plays: what it says and when, and what its reader has seen.
struct Device {
  std::counting_semaphore<16> readings{0};
  std::atomic<bool> broken{false}, told_to_stop{false};
  std::atomic<int> alive{0}, pushed{0};
};
Device* g_device = nullptr;

/// Numbers from 1, four of which wait at most, stamped a tenth of a second apart.
class SlowReader final : public Component {
 public:
  explicit SlowReader(Setup& setup)
      : Component{setup}, queue_{setup.driver_thread<int>(4, [this] { read(); })} {
    ++g_device->alive;
  }
  ~SlowReader() override { --g_device->alive; }

  void step(Time) override {
    while (const auto taken = queue_.take()) {
      samples.push_back(taken->sample);
      stamps_s.push_back(to_seconds(taken->stamp - Time{}));
    }
  }

  std::vector<int> samples;
  std::vector<double> stamps_s;

 private:
  void read() {
    constexpr std::chrono::milliseconds kPoll{1};
    for (int i = 1; !queue_.stopping();) {
      if (!g_device->readings.try_acquire_for(kPoll)) continue;
      if (g_device->broken) throw std::runtime_error{"the cable is out"};
      queue_.push(Time{} + seconds(0.1 * i), i);
      ++i;
      ++g_device->pushed;
    }
    g_device->told_to_stop = g_device->alive == 1;
  }

  DriverQueue<int>& queue_;
};

class DriverThreadTest : public testing::Test {
 protected:
  DriverThreadTest() { g_device = &device_; }
  ~DriverThreadTest() override { g_device = nullptr; }

  std::unique_ptr<ComponentHarness> reader(const std::string& manifest) {
    plugins_.add<SlowReader>(manifest);
    return std::make_unique<ComponentHarness>(
        plugins_, ComponentHarness::Options{.component = "{plugin: test/reader}", .robot = {}});
  }
  /// Lets the device say `count` things, and waits until they are in the queue.
  void read(int count) {
    const int before = device_.pushed;
    device_.readings.release(count);
    while (device_.pushed < before + count) std::this_thread::yield();
  }

  Device device_;
  PluginRegistry plugins_{std::vector<std::filesystem::path>{}};
  const std::string kImpure = std::string{kReaderManifest} + ", pure: false}";
};

TEST_F(DriverThreadTest, WhatItReadsActivatesTheComponentAndComesWithItsOwnStampInOrder) {
  const auto bench = reader(kImpure);
  const auto& component = dynamic_cast<SlowReader&>(bench->component());
  bench->step(1);
  EXPECT_THAT(component.samples, ElementsAre());
  EXPECT_FALSE(bench->triggered());
  read(3);
  while (!bench->triggered()) std::this_thread::yield();
  bench->step(2);
  EXPECT_THAT(component.samples, ElementsAre(1, 2, 3));
  EXPECT_THAT(component.stamps_s, ElementsAre(0.1, 0.2, testing::DoubleNear(0.3, 1e-9)));
}

TEST_F(DriverThreadTest, AFullQueueDropsTheOldestAndCountsIt) {
  const auto bench = reader(kImpure);
  bench->step(1);
  read(7);
  bench->step(2);
  EXPECT_THAT(dynamic_cast<SlowReader&>(bench->component()).samples, ElementsAre(4, 5, 6, 7));
  EXPECT_EQ(bench->dropped(), 3U);
  read(1);
  bench->step(3);
  EXPECT_THAT(dynamic_cast<SlowReader&>(bench->component()).samples, ElementsAre(4, 5, 6, 7, 8));
  EXPECT_EQ(bench->dropped(), 3U);
}

TEST_F(DriverThreadTest, StartsWithTheFirstActivationAndNotWhenTheComponentIsMade) {
  const auto bench = reader(kImpure);
  device_.readings.release();
  std::this_thread::sleep_for(std::chrono::milliseconds{20});
  EXPECT_EQ(device_.pushed, 0);
  bench->step(1);
  while (device_.pushed < 1) std::this_thread::yield();
}

TEST_F(DriverThreadTest, HasReturnedBeforeTheComponentIsDestroyed) {
  auto bench = reader(kImpure);
  bench->step(1);
  bench.reset();
  EXPECT_TRUE(device_.told_to_stop);
  EXPECT_EQ(device_.alive, 0);
}

TEST_F(DriverThreadTest, WhatItThrowsIsTheComponentsFault) {
  const auto bench = reader(kImpure);
  bench->step(1);
  device_.broken = true;
  device_.readings.release();
  std::string fault;
  while (fault.empty()) {
    try {
      bench->step(2);
    } catch (const std::runtime_error& error) {
      fault = error.what();
    }
  }
  EXPECT_EQ(fault, "driver thread failed: the cable is out");
  EXPECT_EQ(bench->status().reason, fault);
}

TEST_F(DriverThreadTest, IsRefusedToAPluginThatPromisesToBeTheSameEveryTime) {
  EXPECT_EQ(test::refusal_of([&] { reader(std::string{kReaderManifest} + "}"); }),
            "plugin 'test/reader' has a driver thread, so no two runs of it are alike; its "
            "plugin.yaml must say 'pure: false'");
}

TEST(DriverThread, ASleepEndsAtOnceWhenTheRunDoes) {
  std::binary_semaphore asleep{0};
  std::atomic<bool> slept_short{false}, slept_long{true};
  DriverQueue<int>* self = nullptr;
  DriverQueue<int> thread{1, [&] {
                            slept_short = self->sleep_for(std::chrono::milliseconds{1});
                            asleep.release();
                            slept_long = self->sleep_for(seconds(100));
                          }};
  self = &thread;
  const std::string name = "sleeper";
  thread.start(name, {.now = [] { return Time{}; }, .wake = [] {}, .fault = [](const auto&) {}});
  asleep.acquire();
  EXPECT_FALSE(thread.join_until(std::chrono::steady_clock::now() + std::chrono::milliseconds{20}));
  thread.request_stop();
  EXPECT_TRUE(thread.join_until(std::chrono::steady_clock::now() + std::chrono::seconds{5}));
  EXPECT_TRUE(slept_short);
  EXPECT_FALSE(slept_long);
}

}  // namespace
}  // namespace armature
