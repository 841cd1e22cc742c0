// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/execution/state_publisher.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/testing/fake_setup.hpp"

namespace armature {
namespace {

/// Keeps copies of what a topic carries.
template <class Message>
class Collector final : public Subscriber {
 public:
  void deliver(const SampleRef& sample) override {
    messages.push_back(*static_cast<const Message*>(sample.message()));
  }
  std::vector<Message> messages;
};

/// Keeps what is told of components, one after the other.
class StateCollector final : public Subscriber {
 public:
  void deliver(const SampleRef& sample) override {
    const auto& told = *static_cast<const msg::ComponentStates*>(sample.message());
    EXPECT_EQ(told.process_(), "main");
    stamp = stamp_of(told.header_().stamp_());
    messages.insert(messages.end(), told.components_().begin(), told.components_().end());
  }
  Time stamp;
  std::vector<msg::ComponentState> messages;
};

/// Three components: one is well, one misses something and has lost samples and periods, one threw.
class StatePublisherTest : public testing::Test {
 protected:
  StatePublisherTest() {
    runners_.push_back(make_runner("arm", 0, [](Time) {}));
    runners_.push_back(make_runner("camera", 1, [](Time) {}));
    runners_.push_back(make_runner("motion", 2, [](Time) { throw std::runtime_error("no way"); }));
    InputPort& full = runners_[1]->inbox().add({.name = "in", .queue = 1}, pool_.type());
    for (int i = 0; i < 4; ++i) full.deliver(pool_.loan());
    runners_[1]->inbox().show({});
    runners_[1]->reporter()->set(StatusReporter::State::degraded, "no light");
    runners_[1]->count_overruns(7);
    for (int i = 0; i < 5; ++i) runners_[0]->activate({});
    for (int i = 0; i < 5; ++i) runners_[2]->activate({});
    setup_.topic("states").connect(states_);
    setup_.topic("diagnostics").connect(diagnostics_);
    setup_.topic("description").connect(descriptions_);
    description_.deployment_("lamp");
    publisher_.step(Time{} + seconds(1.5));
  }

  SamplePool pool_{message_type<msg::Image>(), 4};
  std::vector<std::unique_ptr<ComponentRunner>> runners_;
  std::vector<std::string> lines_;
  ComponentRunner own_{"runtime", "runtime/state_publisher", 3,
                       [this](std::string_view, std::string_view line, StatusReporter::State) {
                         lines_.emplace_back(line);
                       }};
  FakeSetup setup_{own_};
  msg::DeploymentDescription description_;
  StatePublisher publisher_{setup_, "main", runners_, {"camera"}, description_};
  StateCollector states_;
  Collector<msg::DiagnosticArray> diagnostics_;
  Collector<msg::DeploymentDescription> descriptions_;
};

TEST_F(StatePublisherTest, TellsOnceWhatTheProcessConsistsOf) {
  publisher_.step(Time{} + seconds(2));
  ASSERT_EQ(descriptions_.messages.size(), 1U);
  EXPECT_EQ(descriptions_.messages[0].deployment_(), "lamp");
  EXPECT_EQ(stamp_of(descriptions_.messages[0].header_().stamp_()), Time{} + seconds(1.5));
}

TEST_F(StatePublisherTest, TellsHowOldAMeasurementWasWhenItWasAnswered) {
  EXPECT_TRUE(states_.messages[0].reactions_().empty());
  runners_[0]->expect_measurements(1);
  InputPort& image = runners_[0]->inbox().add({.name = "image"}, pool_.type());
  image.set_source(0, true);
  for (const double age_s : {0.004, 0.016}) {
    SampleRef sample = pool_.loan();
    auto& message = *static_cast<msg::Image*>(sample.mutable_message());
    set_stamp(message.header_().stamp_(), Time{} + seconds(1.6));
    image.deliver(sample);
    runners_[0]->activate(Time{} + seconds(1.6 + age_s));
  }
  runners_[0]->activate(Time{} + seconds(1.9));  // with nothing new
  publisher_.step(Time{} + seconds(2));
  const auto& reactions = states_.messages[3].reactions_();
  ASSERT_EQ(reactions.size(), 1U);
  EXPECT_EQ(reactions[0].source_(), "camera");
  EXPECT_EQ(reactions[0].count_(), 2U);
  EXPECT_NEAR(reactions[0].age_().mean_(), 0.010, 1e-9);
  EXPECT_NEAR(reactions[0].age_().max_(), 0.016, 1e-9);
}

TEST_F(StatePublisherTest, TellsOfEveryComponentWhetherItIsWellAndWhyNot) {
  ASSERT_EQ(states_.messages.size(), 3U);
  const auto told = [&](std::size_t i) {
    const msg::ComponentState& state = states_.messages[i];
    EXPECT_EQ(state.plugin_(), "test/lambda");
    return std::tuple{state.component_(), static_cast<int>(state.state_()), state.reason_()};
  };
  EXPECT_EQ(states_.stamp, Time{} + seconds(1.5));
  EXPECT_EQ(told(0), (std::tuple{"arm", 0, ""}));
  EXPECT_EQ(told(1), (std::tuple{"camera", 1, "no light"}));
  EXPECT_EQ(told(2), (std::tuple{"motion", 2, "step failed: no way"}));
}

TEST_F(StatePublisherTest, CountsActivationsMissedPeriodsAndLostSamples) {
  const auto counts = [&](std::size_t i) {
    const msg::ComponentState& state = states_.messages[i];
    return std::vector<std::uint64_t>{state.activations_(), state.overruns_(), state.dropped_()};
  };
  EXPECT_EQ(counts(0), (std::vector<std::uint64_t>{5, 0, 0}));
  EXPECT_EQ(counts(1), (std::vector<std::uint64_t>{0, 7, 3}));
  EXPECT_EQ(counts(2), (std::vector<std::uint64_t>{1, 0, 0}));  // not called again after its fault
}

TEST_F(StatePublisherTest, TellsRosToolsTheSameOnDiagnostics) {
  ASSERT_EQ(diagnostics_.messages.size(), 1U);
  const msg::DiagnosticArray& array = diagnostics_.messages[0];
  EXPECT_EQ(stamp_of(array.header_().stamp_()), Time{} + seconds(1.5));
  ASSERT_EQ(array.status_().size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const msg::DiagnosticStatus& diagnostic = array.status_()[i];
    const msg::ComponentState& state = states_.messages[i];
    EXPECT_EQ(diagnostic.level_(), state.state_());  // OK 0, WARN 1, ERROR 2
    EXPECT_EQ(diagnostic.name_(), state.component_());
    EXPECT_EQ(diagnostic.message_(), state.reason_());
    EXPECT_EQ(diagnostic.hardware_id_(), "test/lambda");
    std::vector<std::string> values;
    for (const auto& value : diagnostic.values_()) {
      values.push_back(value.key_() + "=" + value.value_());
    }
    ASSERT_EQ(values.size(), 18U);
    const std::vector<std::string> counts{values.begin(), values.begin() + 3};
    EXPECT_EQ(counts,
              (std::vector<std::string>{"activations=" + std::to_string(state.activations_()),
                                        "overruns=" + std::to_string(state.overruns_()),
                                        "dropped=" + std::to_string(state.dropped_())}));
    EXPECT_EQ(values[12], fmt::format("step_max_us={:.3f}", 1e6 * state.step_().max_()));
  }
}

/// A histogram as a message tells of it.
std::vector<double> told_us(const msg::StepTiming& times) {
  std::vector<double> us;
  for (const double s : {times.last_(), times.mean_(), times.p99_(), times.max_()}) {
    us.push_back(std::round(1e6 * s));
  }
  return us;
}

TEST_F(StatePublisherTest, TellsHowLateAndHowLongTheStepsSinceTheLastTimeWere) {
  EXPECT_EQ(told_us(states_.messages[1].step_()), (std::vector<double>{0, 0, 0, 0}))
      << "the camera was not activated";
  EXPECT_GT(states_.messages[0].step_().max_(), 0);
  EXPECT_LE(states_.messages[0].step_().p99_(), states_.messages[0].step_().max_());
  for (int i = 0; i < 100; ++i)
    runners_[0]->activate({}, std::chrono::microseconds{i < 50 ? 8 : 16});
  publisher_.step({});
  EXPECT_EQ(told_us(states_.messages[3].lateness_()), (std::vector<double>{16, 12, 16, 16}));
  publisher_.step({});
  EXPECT_EQ(told_us(states_.messages[6].lateness_()), (std::vector<double>{0, 0, 0, 0}));
}

TEST_F(StatePublisherTest, TellsTheSameOfEveryExecutorOnce) {
  const std::string name = "control";
  CycleTimes times;
  for (int i = 0; i < 2; ++i) runners_[static_cast<std::size_t>(i)]->set_executor(name, times);
  times.lateness.add(std::chrono::microseconds{30});
  times.duration.add(std::chrono::microseconds{200});
  publisher_.step({});
  for (const std::size_t i : {3U, 4U}) {
    EXPECT_EQ(states_.messages[i].executor_(), "control");
    EXPECT_EQ(told_us(states_.messages[i].executor_lateness_())[1], 30);
    EXPECT_EQ(told_us(states_.messages[i].executor_cycle_())[1], 200);
  }
  EXPECT_EQ(states_.messages[5].executor_(), "");
  const msg::DiagnosticArray& array = diagnostics_.messages[1];
  ASSERT_EQ(array.status_().size(), 4U);
  EXPECT_EQ(array.status_()[3].name_(), "executor control");
  EXPECT_EQ(array.status_()[3].values_()[6].key_(), "cycle_mean_us");
  EXPECT_EQ(array.status_()[3].values_()[6].value_(), "200.000");
}

TEST_F(StatePublisherTest, AStepThatHangsIsStalledForAsLongAsItDoes) {
  runners_[1]->set_stalled(seconds(3.25));
  publisher_.step({});
  EXPECT_EQ(states_.messages[4].state_(), 3);
  EXPECT_EQ(states_.messages[4].reason_(), "its step has not returned for 3.2 s");
  EXPECT_EQ(diagnostics_.messages[1].status_()[1].level_(), 3) << "STALE";
  runners_[1]->set_stalled({});
  publisher_.step({});
  EXPECT_EQ(states_.messages[7].reason_(), "no light") << "as before";
}

TEST_F(StatePublisherTest, AComponentThatIsWellAgainHasNoReasonAnyMore) {
  runners_[1]->reporter()->set(StatusReporter::State::ok, {});
  publisher_.step(Time{} + seconds(2));
  EXPECT_EQ(states_.messages[4].component_(), "camera");
  EXPECT_EQ(states_.messages[4].state_(), 0);
  EXPECT_EQ(states_.messages[4].reason_(), "");
}

TEST_F(StatePublisherTest, AComponentThatMissesMostOfItsPeriodsForASecondIsDegraded) {
  using Told = std::pair<int, std::string>;
  const auto arm_after = [&](std::uint64_t missed, int kept) {
    runners_[0]->count_overruns(missed);
    for (int i = 0; i < kept; ++i) runners_[0]->activate({});
    publisher_.step({});
    const msg::ComponentState& arm = states_.messages[states_.messages.size() - 3];
    return Told{arm.state_(), arm.reason_()};
  };
  EXPECT_EQ(arm_after(490, 10), (Told{0, ""})) << "once may be while everything starts";
  EXPECT_EQ(arm_after(490, 10), (Told{1, "keeps 10 of 500 periods"}));
  EXPECT_EQ(arm_after(491, 9), (Told{1, "keeps 9 of 500 periods"}));
  EXPECT_EQ(lines_,
            std::vector<std::string>{"'arm' misses more periods than it keeps: 490 of 500"});
  EXPECT_EQ(arm_after(200, 300), (Told{0, ""})) << "a busy machine";
}

/// Its scenario is told at once.
class Told final : public Component {
 public:
  using Component::Component;
  void step(Time) override {}
  bool finished() const override { return true; }
};

TEST_F(StatePublisherTest, AComponentThatHasToldItsScenarioMissesNoPeriods) {
  runners_.push_back(
      std::make_unique<ComponentRunner>("report", "test/told", 3, StatusReporter::Sink{}));
  ComponentRunner& report = *runners_.back();
  FakeSetup setup{report};
  report.install(nullptr, std::make_unique<Told>(setup));
  report.activate({});
  for (int i = 0; i < 3; ++i) {
    report.count_overruns(50);
    publisher_.step({});
  }
  EXPECT_EQ(states_.messages.back().component_(), "report");
  EXPECT_EQ(states_.messages.back().reason_(), "");
  runners_.pop_back();
}

TEST_F(StatePublisherTest, AnInputThatIsStampedAheadOfNowIsAReasonWhileItComes) {
  const auto of_arm = [&] { return states_.messages[states_.messages.size() - 3]; };
  InputPort& port = runners_[0]->inbox().add({.name = "measured_js"}, pool_.type());
  SampleRef sample = pool_.loan();
  set_stamp(static_cast<msg::Image*>(sample.mutable_message())->header_().stamp_(),
            Time{} + seconds(3600));
  port.deliver(sample);
  runners_[0]->activate({});
  publisher_.step(Time{} + seconds(2));
  const std::string reason =
      "input 'measured_js' is stamped 3.6e+03 s ahead of now, so it is not shown";
  EXPECT_EQ(of_arm().reason_(), reason);
  EXPECT_EQ(of_arm().state_(), 1);
  EXPECT_EQ(lines_, std::vector<std::string>{"'arm': " + reason});
  publisher_.step(Time{} + seconds(2.5));
  EXPECT_EQ(of_arm().state_(), 0) << "it has stopped";
}

TEST_F(StatePublisherTest, TellsTwiceASecondOnTheTopicsThatRosToolsKnow) {
  EXPECT_EQ(own_.period(), seconds(0.5));
  const auto& outputs = StatePublisher::manifest().outputs;
  ASSERT_EQ(outputs.size(), 3U);
  EXPECT_EQ(outputs[0].topic, "component_states");  // of the deployment
  EXPECT_EQ(outputs[1].topic, "description");
  EXPECT_EQ(outputs[2].topic, "/diagnostics");  // of everybody
}

}  // namespace
}  // namespace armature
