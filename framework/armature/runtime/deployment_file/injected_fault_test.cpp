// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/injected_fault.hpp"

#include <gmock/gmock.h>

#include <csignal>

#include "armature/runtime/testing/fake_setup.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

using testing::HasSubstr;

class InjectedFaultTest : public testing::Test {
 protected:
  InjectedFaultTest() {
    driver_.id = "arm/simulated";
    driver_.driver = DriverSpec{.simulated = true};
    deployment_.components = {{.name = "arm", .manifest = &driver_},
                              {.name = "monitor", .manifest = &monitor_}};
  }
  std::string refusal(std::string_view text) const {
    return test::refusal_of([&] { InjectedFault::read(text, deployment_); });
  }

  PluginManifest driver_, monitor_;
  DeploymentConfig deployment_;
};

TEST_F(InjectedFaultTest, StrikesInTheNextStepOnceTheSignalHasCome) {
  const auto fault = InjectedFault::read("monitor:throw", deployment_);
  EXPECT_EQ(fault.component(), "monitor");
  int steps = 0;
  const auto runner = make_runner("monitor", 0, [&](Time) { ++steps; });
  runner->inject(fault);
  InjectedFault::listen();
  runner->activate({});
  EXPECT_FALSE(runner->faulted());
  std::raise(SIGUSR1);
  runner->activate({});
  EXPECT_TRUE(runner->faulted());
  EXPECT_EQ(runner->status().reason, "step failed: a drill's fault");
  EXPECT_EQ(steps, 1);
}

TEST_F(InjectedFaultTest, NamesWhatIsWrongWithIt) {
  EXPECT_EQ(refusal("monitr:throw"),
            "--inject monitr:throw: no component 'monitr'; did you mean 'monitor'?");
  EXPECT_EQ(refusal("monitor:trow"),
            "--inject monitor:trow: a component cannot 'trow'; did you mean 'throw'?");
  EXPECT_THAT(refusal("monitor"), HasSubstr("a component cannot ''"));
}

TEST_F(InjectedFaultTest, IsRefusedWhereADriverMovesMetal) {
  driver_.driver->simulated = false;
  EXPECT_EQ(refusal("monitor:throw"),
            "--inject monitor:throw: 'arm' (arm/simulated) moves metal; faults are only put into a "
            "run whose drivers are all 'simulated: true'");
}

}  // namespace
}  // namespace armature
