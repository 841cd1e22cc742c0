// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <thread>

#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "test_breaker_parameters.hpp"

namespace armature::test::breaker {

class Breaker final : public Component {
 public:
  explicit Breaker(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        note_{setup.output<msg::String>("note")} {
    setup.activate_every(seconds(0.02));
    if (parameters_.breaks == Parameters::Breaks::crashes_when_made) std::raise(SIGSEGV);
    if (parameters_.breaks == Parameters::Breaks::exits_when_made) std::exit(0);
    if (parameters_.breaks == Parameters::Breaks::takes_long_to_make) {
      std::this_thread::sleep_for(std::chrono::seconds{6});
    }
  }
  ~Breaker() override {
    if (parameters_.breaks == Parameters::Breaks::crashes_at_its_end) std::raise(SIGSEGV);
  }
  Breaker(const Breaker&) = delete;
  Breaker& operator=(const Breaker&) = delete;

  void step(Time now) override {
    if (!start_) start_ = now;
    if (!broken_ && now - *start_ >= seconds(parameters_.after)) {
      broken_ = true;
      break_now();
    }
    auto loan = note_.loan();
    loan->data_() = "well";
    loan.publish();
  }

 private:
  void break_now() const {
    using enum Parameters::Breaks;
    const auto breaks = parameters_.breaks;
    if (breaks == throws) throw std::runtime_error{"a marker has no colour"};
    if (breaks == hangs)
      std::this_thread::sleep_for(std::chrono::duration<double>{parameters_.hangs});
    if (breaks == crashes) std::raise(SIGSEGV);
    if (breaks == exits) std::exit(0);
    if (breaks == exits_quickly) std::quick_exit(0);
    if (breaks == prints) {
      std::printf("[printed\n");
      std::cout << "[streamed" << std::endl;
      [[maybe_unused]] const int status = std::system("echo [echoed");
    }
  }

  Parameters parameters_;
  Output<msg::String> note_;
  std::optional<Time> start_;
  bool broken_ = false;
};

}  // namespace armature::test::breaker

ARMATURE_PLUGIN(armature::test::breaker::Breaker);
