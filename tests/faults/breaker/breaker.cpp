// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <csignal>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"

namespace armature {

class Breaker final : public Component {
 public:
  explicit Breaker(Setup& setup)
      : Component{setup},
        breaks_{setup.params().text("breaks")},
        after_{seconds(setup.params().number("after_s"))},
        hangs_s_{setup.params().number("hangs_s")},
        note_{setup.output<msg::String>("note")} {
    setup.activate_every(seconds(0.02));
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    if (!broken_ && now - *start_ >= after_) {
      broken_ = true;
      break_now();
    }
    auto loan = note_.loan();
    loan->data_() = "well";
    loan.publish();
  }

 private:
  void break_now() const {
    if (breaks_ == "throws") throw std::runtime_error{"a marker has no colour"};
    if (breaks_ == "hangs") std::this_thread::sleep_for(std::chrono::duration<double>{hangs_s_});
    if (breaks_ == "crashes") std::raise(SIGSEGV);
  }

  std::string breaks_;
  Duration after_;
  double hangs_s_;
  Output<msg::String> note_;
  std::optional<Time> start_;
  bool broken_ = false;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::Breaker);
