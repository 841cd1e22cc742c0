// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component/slot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>

#include "armature/runtime/plugins/plugin.hpp"
#include "armature/runtime/testing/fake_setup.hpp"

namespace armature {
namespace {

using testing::HasSubstr;

/// A kind whose plugins tell a number, and how many of them there are.
class Gauge {
 public:
  static constexpr std::string_view kKind = "gauge";
  using Factory = Expected<std::unique_ptr<Gauge>> (*)(std::atomic<int>*, const Params&);

  explicit Gauge(std::atomic<int>* alive) : alive_{alive} { ++*alive_; }
  virtual ~Gauge() { --*alive_; }
  virtual int read() const = 0;

 private:
  std::atomic<int>* alive_;
};

template <int Reading>
class Reads final : public Gauge {
 public:
  Reads(std::atomic<int>* alive, const Params&) : Gauge{alive} {}
  int read() const override { return Reading; }
};
class Refuses final : public Gauge {
 public:
  static Expected<std::unique_ptr<Gauge>> make(std::atomic<int>*, const Params&) {
    return refuse("no battery");
  }
};
class Throws final : public Gauge {
 public:
  Throws(std::atomic<int>* alive, const Params&) : Gauge{alive} {
    throw std::runtime_error("no device");
  }
  int read() const override { return 0; }
};

template <class Plugin>
SlotPlugin plugin(const char* id) {
  SlotPlugin made;
  made.library = *PluginLibrary::of_this_program(detail::plugin_entry<Plugin>(), "gauge");
  made.manifest.id = id;
  return made;
}

class SlotTest : public testing::Test {
 protected:
  std::atomic<int> alive_{0};
  SlotOf<Gauge> place_{"gauge", [this](Gauge::Factory factory, const Params& params) {
                         return factory(&alive_, params);
                       }};
  const Slot<Gauge> slot_{place_};
};

TEST_F(SlotTest, TheFirstPluginSitsThereAtOnce) {
  place_.fill(plugin<Reads<1>>("gauge/one"));
  EXPECT_EQ(slot_->read(), 1);
  EXPECT_EQ(place_.manifest().id, "gauge/one");
}

TEST_F(SlotTest, ASuccessorWaitsForTheNextExchange) {
  place_.fill(plugin<Reads<1>>("gauge/one"));
  ASSERT_TRUE(place_.offer(plugin<Reads<2>>("gauge/two")));
  EXPECT_EQ(slot_->read(), 1);
  EXPECT_FALSE(place_.settle());
  place_.exchange();
  EXPECT_EQ(slot_->read(), 2);
  EXPECT_EQ(place_.manifest().id, "gauge/two");
  EXPECT_TRUE(place_.settle());
}

TEST_F(SlotTest, EveryHandleLeadsToTheSuccessor) {
  place_.fill(plugin<Reads<1>>("gauge/one"));
  const Slot<Gauge> copy = slot_;
  const Slot<const Gauge> narrower = slot_;
  ASSERT_TRUE(place_.offer(plugin<Reads<2>>("gauge/two")));
  place_.exchange();
  EXPECT_EQ(copy->read(), 2);
  EXPECT_EQ(narrower->read(), 2);
}

TEST_F(SlotTest, ThePredecessorIsFreedByWhoOfferedAndNotByTheExchange) {
  place_.fill(plugin<Reads<1>>("gauge/one"));
  ASSERT_TRUE(place_.offer(plugin<Reads<2>>("gauge/two")));
  place_.exchange();
  EXPECT_EQ(alive_, 2);
  place_.settle();
  EXPECT_EQ(alive_, 1);
}

TEST_F(SlotTest, ASecondSuccessorReplacesTheOneThatWaits) {
  place_.fill(plugin<Reads<1>>("gauge/one"));
  ASSERT_TRUE(place_.offer(plugin<Reads<2>>("gauge/two")));
  ASSERT_TRUE(place_.offer(plugin<Reads<3>>("gauge/three")));
  EXPECT_EQ(alive_, 2) << "the second is gone without having sat there";
  place_.exchange();
  EXPECT_EQ(slot_->read(), 3);
}

TEST_F(SlotTest, ASuccessorWaitsUntilThePredecessorsPredecessorIsFreed) {
  place_.fill(plugin<Reads<1>>("gauge/one"));
  ASSERT_TRUE(place_.offer(plugin<Reads<2>>("gauge/two")));
  place_.exchange();
  ASSERT_TRUE(place_.offer(plugin<Reads<3>>("gauge/three")));
  place_.exchange();
  EXPECT_EQ(slot_->read(), 2);
  EXPECT_FALSE(place_.settle());
  place_.exchange();
  EXPECT_EQ(slot_->read(), 3);
}

TEST_F(SlotTest, APluginThatRefusesChangesNothing) {
  place_.fill(plugin<Reads<1>>("gauge/one"));
  const auto offered = place_.offer(plugin<Refuses>("gauge/broken"));
  ASSERT_FALSE(offered);
  EXPECT_THAT(offered.error().text, HasSubstr("gauge/broken refuses: no battery"));
  EXPECT_TRUE(place_.settle()) << "nothing waits";
  place_.exchange();
  EXPECT_EQ(slot_->read(), 1);
}

TEST_F(SlotTest, APluginThatThrowsChangesNothing) {
  place_.fill(plugin<Reads<1>>("gauge/one"));
  const auto offered = place_.offer(plugin<Throws>("gauge/throws"));
  ASSERT_FALSE(offered);
  EXPECT_THAT(offered.error().text, HasSubstr("no device"));
  place_.exchange();
  EXPECT_EQ(slot_->read(), 1);
  EXPECT_EQ(alive_, 1);
}

TEST_F(SlotTest, TheComponentMayObjectToASuccessor) {
  place_.fill(plugin<Reads<1>>("gauge/one"));
  Slot<Gauge>{place_}.object_to([](const PluginManifest& successor) {
    return successor.allocates ? "'" + successor.id + "' allocates" : "";
  });
  SlotPlugin allocating = plugin<Reads<2>>("gauge/two");
  allocating.manifest.allocates = true;
  const auto offered = place_.offer(allocating);
  ASSERT_FALSE(offered);
  EXPECT_EQ(offered.error().text, "'gauge/two' allocates");
  EXPECT_EQ(alive_, 1) << "it was not even made";
  EXPECT_TRUE(place_.offer(plugin<Reads<2>>("gauge/two")));
}

TEST_F(SlotTest, TheFirstPluginThatRefusesIsASlotErrorWithTheSlotsName) {
  try {
    place_.fill(plugin<Refuses>("gauge/broken"));
    FAIL() << "it was taken";
  } catch (const SlotError& error) {
    EXPECT_EQ(error.slot(), "gauge");
    EXPECT_THAT(error.what(), HasSubstr("gauge/broken refuses: no battery"));
  }
}

TEST_F(SlotTest, ALibraryStaysAsLongAsTheSlotForWhatItsPluginHasTold) {
  SlotPlugin first = plugin<Reads<1>>("gauge/one"), refused = plugin<Refuses>("gauge/broken");
  const std::weak_ptr<PluginLibrary> library = first.library, of_refused = refused.library;
  {
    SlotOf<Gauge> place{"gauge", [this](Gauge::Factory factory, const Params& params) {
                          return factory(&alive_, params);
                        }};
    place.fill(std::move(first));
    EXPECT_FALSE(place.offer(std::move(refused)));
    EXPECT_TRUE(of_refused.expired()) << "it never sat there";
    ASSERT_TRUE(place.offer(plugin<Reads<2>>("gauge/two")));
    place.exchange();
    place.settle();
    EXPECT_EQ(alive_, 1) << "its object is gone";
    EXPECT_FALSE(library.expired());
  }
  EXPECT_TRUE(library.expired());
}

TEST(SlotHandle, LeadsToAPluginThatIsNeverExchanged) {
  std::atomic<int> alive{0};
  Reads<7> fixed{&alive, {}};
  EXPECT_EQ((Slot<const Gauge>{fixed})->read(), 7);
  EXPECT_FALSE(Slot<Gauge>{});
}

TEST_F(SlotTest, AnActivationSeesOnePluginWhileAnotherThreadOffersSuccessors) {
  auto place = std::make_unique<SlotOf<Gauge>>(
      "gauge",
      [this](Gauge::Factory factory, const Params& params) { return factory(&alive_, params); });
  place->fill(plugin<Reads<1>>("gauge/one"));
  SlotPlace& shared = *place;
  const Slot<Gauge> slot{*place};
  std::atomic<int> steps{0}, mixed{0}, changes{0};
  int last = 1;
  const auto runner = make_runner("reader", 0, [&](Time) {
    const int seen = slot->read();
    std::this_thread::yield();
    if (slot->read() != seen) ++mixed;
    if (std::exchange(last, seen) != seen) ++changes;
    ++steps;
  });
  runner->slots().push_back(std::move(place));

  std::jthread steering{[&](const std::stop_token& stop) {
    while (!stop.stop_requested()) runner->step(Time{});
  }};
  for (int round = 0; round < 200; ++round) {
    ASSERT_TRUE(shared.offer(round % 2 == 0 ? plugin<Reads<2>>("gauge/two")
                                            : plugin<Reads<1>>("gauge/one")));
    while (!shared.settle()) std::this_thread::yield();
  }
  steering.request_stop();
  steering.join();
  EXPECT_EQ(mixed, 0);
  EXPECT_GE(changes, 199);
  EXPECT_LE(alive_, 2);
  EXPECT_FALSE(runner->faulted());
}

}  // namespace
}  // namespace armature
