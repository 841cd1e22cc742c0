// SPDX-License-Identifier: Apache-2.0
// The unit that owns an arm's reference asks for no memory, in all four deployments: while goals
// are planned for it and executed, while it tracks, when it is stopped and when the run ends.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>

#include "armature/config/document.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/values/allocation_count.hpp"
#include "armature/values/sanitizer.hpp"

namespace {

std::atomic<long> motion_allocations{0};
std::atomic<long> other_allocations{0};

/// By whether the thread runs the main unit of a motion component.
void count_by_component() {
  const char* name = armature::RunningComponent::name();
  if (!name) return;
  const bool motion = std::strcmp(name, "motion") == 0 || std::strcmp(name, "leader_motion") == 0;
  ++(motion ? motion_allocations : other_allocations);
}

}  // namespace

namespace armature {
namespace {

struct Case {
  const char* deployment;
  std::vector<std::string> settings;
  double stop_at_s = 0;  // somebody writes on /stop; 0: never
};

std::ostream& operator<<(std::ostream& out, const Case& one) {
  out << one.deployment;
  for (const auto& setting : one.settings) out << " " << setting;
  if (one.stop_at_s > 0) out << " stopped after " << one.stop_at_s << " s";
  return out;
}

/// Writes `true` on /stop once, at a simulated time.
class StopAt final : public RunWatch {
 public:
  StopAt(Deployment& deployment, double time_s)
      : deployment_{deployment}, at_{Time{} + seconds(time_s)}, wanted_{time_s > 0} {}

  std::optional<std::string> stop_cause() override {
    const Time now = deployment_.clock().now();
    if (!wanted_ || now < at_) return std::nullopt;
    if (!sent_) send();
    // Long enough for everything to have been refused a few times.
    return now > at_ + seconds(2) ? std::optional<std::string>{"enough"} : std::nullopt;
  }

 private:
  void send() {
    sent_ = true;
    for (const auto& runner : deployment_.runners()) {
      for (const auto& port : runner->inbox().ports()) {
        if (port->spec().name != "stop") continue;
        SampleRef sample = pool_.loan();
        static_cast<msg::Bool*>(sample.mutable_message())->data_(true);
        sample.mutable_info().published = deployment_.clock().now();
        port->deliver(sample);
      }
    }
  }

  SamplePool pool_{message_type<msg::Bool>(), 8};
  Deployment& deployment_;
  Time at_;
  bool wanted_, sent_ = false;
};

class MotionAllocations : public testing::TestWithParam<Case> {};

TEST_P(MotionAllocations, AreNone) {
  if (kSanitized) GTEST_SKIP() << "the sanitizer's malloc cannot be counted";
  PluginRegistry plugins{{ARMATURE_PLUGIN_BUILD_DIR}};
  std::vector<std::string> settings = GetParam().settings;
  settings.push_back("clock=simulated");
  config::Problems problems;
  DeploymentConfig config = read_deployment(
      config::load_with_overlays(
          {std::string{ARMATURE_SOURCE_DIR "/configs/"} + GetParam().deployment}, settings),
      plugins, problems);
  problems.throw_if_any();
  Deployment deployment{std::move(config), plugins, {.process = "main"}};
  StopAt watch{deployment, GetParam().stop_at_s};
  motion_allocations = other_allocations = 0;
  on_allocation = count_by_component;
  deployment.run(watch);
  on_allocation = nullptr;
  EXPECT_EQ(motion_allocations, 0);
  EXPECT_GT(other_allocations, 0) << "nothing is counted";
}

INSTANTIATE_TEST_SUITE_P(
    , MotionAllocations,
    testing::Values(
        Case{"dental_lamp.yaml", {}}, Case{"dental_lamp.yaml", {}, 4.5},
        Case{"sr1_biopsy.yaml", {}}, Case{"sr1_biopsy.yaml", {}, 3},
        Case{"dental_implant.yaml", {}}, Case{"dental_implant.yaml", {}, 40},
        Case{"master_manipulator.yaml", {}}, Case{"master_manipulator.yaml", {}, 8},
        Case{"master_manipulator.yaml", {"components.surgeon.params.silent_after_s=3"}},
        Case{"master_manipulator.yaml",
             {"components.surgeon.params.curve_mm=[-30, 30, 20]",
              "components.surgeon.params.curve_hz=0.4"}},  // faster than the follower may be
        Case{"sr1_biopsy.yaml", {"components.arm.params.lag_s=1"}}));

}  // namespace
}  // namespace armature
