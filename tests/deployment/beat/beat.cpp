// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/component.hpp"
#include "armature/runtime/plugin.hpp"
#include "armature/runtime/setup.hpp"

namespace armature {

class Beat final : public Component {
 public:
  explicit Beat(Setup& setup)
      : Component{setup},
        beats_{setup.params().integer("beats")},
        ends_{setup.params().flag("ends")},
        stop_s_{setup.params().number("stop_s")},
        throws_in_{setup.params().text("throws_in")},
        hangs_in_{setup.params().text("hangs_in")},
        throws_number_{setup.params().flag("throws_number")},
        beat_{setup.output<msg::Capture>("beat")} {
    setup.activate_every(seconds(0.01));
    const double construction_s = setup.params().number("construction_s");
    throw_in("construction");
    if (construction_s == 0) return;
    say("being constructed");
    std::this_thread::sleep_for(std::chrono::duration<double>{construction_s});
  }

  ~Beat() override { hang_in("destructor"); }

  void step(Time now) override {
    throw_in("step");
    if (beats_ > 0 && sent_ == beats_) return;
    ++sent_;
    auto loan = beat_.loan();
    set_stamp(loan->header_().stamp_(), now);
    loan->header_().frame_id_().clear();
    loan->on_(true);
    loan.publish();
  }

  void stop(Time) override {
    throw_in("stop");
    hang_in("stop");
    if (stop_s_ == 0) return;
    std::this_thread::sleep_for(std::chrono::duration<double>{stop_s_});
    say("ended");
  }
  bool finished() const override { return ends_ && sent_ == beats_; }
  void summarize(Summary&) const override {
    throw_in("summarize");
    hang_in("summarize");
  }
  void write_files(const std::filesystem::path&) const override { hang_in("write_files"); }

 private:
  void throw_in(const char* place) const {
    if (throws_in_ != place) return;
    if (throws_number_) throw 42;
    throw std::runtime_error{"out of breath"};
  }

  void hang_in(const char* place) const {
    while (hangs_in_ == place) std::this_thread::sleep_for(std::chrono::seconds{1});
  }

  std::int64_t beats_, sent_ = 0;
  bool ends_;
  double stop_s_;
  std::string throws_in_, hangs_in_;
  bool throws_number_;
  Output<msg::Capture> beat_;
};

}  // namespace armature

ARMATURE_PLUGIN(armature::Beat);
