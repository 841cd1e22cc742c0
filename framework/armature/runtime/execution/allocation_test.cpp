// SPDX-License-Identifier: Apache-2.0
// What runs in every cycle of a control thread asks for no memory, once it has run a few times.
#include <gtest/gtest.h>

#include "armature/runtime/execution/executor.hpp"
#include "armature/runtime/testing/fake_setup.hpp"
#include "armature/values/allocation_count.hpp"

namespace armature {
namespace {

MessageType instant_type() {
  MessageType type;
  type.ros_name = "test_msgs/Instant";
  type.create = [] { return static_cast<void*>(new Time{}); };
  type.destroy = [](void* message) { delete static_cast<Time*>(message); };
  type.stamp = [](const void* message) { return *static_cast<const Time*>(message); };
  return type;
}

class AllocationTest : public testing::Test {
 protected:
  void SetUp() override {
#ifndef ARMATURE_COUNTS_ALLOCATIONS
    GTEST_SKIP() << "the sanitizer's malloc cannot be counted";
#endif
    ASSERT_GT(allocations_of([] { ::operator delete(::operator new(8)); }), 0U);
  }
  SampleRef sample(Time stamp) {
    SampleRef made = pool_.loan();
    *static_cast<Time*>(made.mutable_message()) = stamp;
    return made;
  }

  MessageType type_ = instant_type();
  SamplePool pool_{type_, 32};
};

TEST_F(AllocationTest, NoneInAnInboxWhateverItsPortsRead) {
  Inbox inbox{[] {}};
  InputPort& latest = inbox.add({.name = "latest"}, type_);
  InputPort& queue = inbox.add({.name = "queue", .queue = 3, .max_age = seconds(1)}, type_);
  InputPort& left = inbox.add({.name = "left", .join = true}, type_);
  InputPort& right = inbox.add({.name = "right", .join = true}, type_);
  EXPECT_EQ(allocations_of([&] {
              for (int i = 0; i < 1000; ++i) {
                for (InputPort* port : {&latest, &queue, &queue}) port->deliver(sample(Time{i}));
                left.deliver(sample(Time{i}));
                if (i % 3 != 0) right.deliver(sample(Time{i - i % 2}));  // some never match
                if (i % 5 == 0) inbox.show(Time{i});
              }
            }),
            0U);
  EXPECT_EQ(pool_.grown(), 0U);
}

/// A kind of which there is one plugin.
struct Idle {
  static constexpr std::string_view kKind = "idle";
  using Factory = Expected<std::unique_ptr<Idle>> (*)(const Params&);
};

TEST_F(AllocationTest, NoneInTheExchangeOfAPlugin) {
  const auto runner = make_runner("arm", 0, [](Time) {});
  auto place = std::make_unique<SlotOf<Idle>>(
      "idle", [](Idle::Factory factory, const Params& params) { return factory(params); });
  const auto idle = [] {
    return SlotPlugin{
        *PluginLibrary::of_this_program(detail::plugin_entry<Idle>(), Idle::kKind), {}, {}};
  };
  place->fill(idle());
  SlotPlace& slot = *place;
  runner->slots().push_back(std::move(place));
  runner->step(Time{});
  ASSERT_TRUE(slot.offer(idle()));
  EXPECT_EQ(allocations_of([&] { runner->step(Time{}); }), 0U);
  EXPECT_TRUE(slot.settle()) << "the successor sits there";
}

TEST_F(AllocationTest, NoneInAnActivationAndItsTimes) {
  int steps = 0;
  const auto runner = make_runner("arm", 0, [&](Time) { ++steps; });
  EXPECT_EQ(allocations_of([&] {
              for (int i = 0; i < 1000; ++i) runner->activate(Time{i}, Duration{i});
            }),
            0U);
  EXPECT_EQ(steps, 1000);
}

TEST_F(AllocationTest, NoneInAnExecutorsCycle) {
  const SystemClock clock;
  std::atomic<int> steps{0};
  std::atomic<std::size_t> first{0}, last{0};
  const auto runner = make_runner("arm", 0, [&](Time) {
    if (steps == 10) first = allocation_count;
    last = allocation_count;
    ++steps;
  });
  InputPort& trigger = runner->inbox().add({.name = "in", .trigger = true}, type_);
  Executor executor{{.name = "control", .period = seconds(0.001)}, clock};
  executor.assign(*runner);
  executor.start([](const std::string&) {});
  while (steps < 200) trigger.deliver(sample(Time{1}));
  executor.request_stop();
  executor.join();
  EXPECT_EQ(last - first, 0U);
}

}  // namespace
}  // namespace armature
