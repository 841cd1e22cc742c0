// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cfenv>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "test_beat_parameters.hpp"

namespace armature::test::beat {

class Beat final : public Component {
 public:
  explicit Beat(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        beat_{setup.output<msg::Capture>("beat")},
        order_{setup.output<msg::Capture>("order")} {
    setup.activate_every(seconds(0.01));
    throw_in(Parameters::ThrowsIn::construction);
    if (parameters_.beats_when_made) send(Time{});
    if (parameters_.construction == 0) return;
    log("being constructed");
    std::this_thread::sleep_for(std::chrono::duration<double>{parameters_.construction});
  }

  ~Beat() override {
    hang_in(Parameters::HangsIn::destructor);
    if (parameters_.exit_code != 0) _exit(static_cast<int>(parameters_.exit_code));
  }

  void step(Time now) override {
    throw_in(Parameters::ThrowsIn::step);
    if (parameters_.ignores_children) std::signal(SIGCHLD, SIG_IGN);
    if (parameters_.gasps) degraded("out of breath");
    if (!std::exchange(has_taken_, true)) take();
    if (parameters_.beats > 0 && sent_ == parameters_.beats) return;
    ++sent_;
    send(now);
  }

  void stop(Time) override {
    throw_in(Parameters::ThrowsIn::stop);
    hang_in(Parameters::HangsIn::stop);
    if (parameters_.stop == 0) return;
    std::this_thread::sleep_for(std::chrono::duration<double>{parameters_.stop});
    log("ended");
  }
  bool finished() const override { return parameters_.ends && sent_ == parameters_.beats; }
  void summarize(Summary& summary) const override {
    throw_in(Parameters::ThrowsIn::summarize);
    hang_in(Parameters::HangsIn::summarize);
    if (parameters_.fails) summary.failed("", "the heart stood still");
  }
  void write_files(const std::filesystem::path& folder) const override {
    hang_in(Parameters::HangsIn::write_files);
    throw_in(Parameters::ThrowsIn::write_files);
    if (parameters_.writes_files) std::ofstream{folder / "beats.txt"} << sent_;
  }

 private:
  void send(Time now) {
    for (Output<msg::Capture>* output : {&beat_, &order_}) {
      auto loan = output->loan();
      set_stamp(loan->header_().stamp_(), now);
      loan->header_().frame_id_().clear();
      loan->on_(true);
      loan.publish();
    }
  }

  void take() const {
    switch (parameters_.takes) {
      case Parameters::Takes::nothing: break;
      case Parameters::Takes::signals:
        for (const int signal : {SIGINT, SIGTERM, SIGQUIT, SIGHUP}) std::signal(signal, SIG_DFL);
        break;
      case Parameters::Takes::folder: std::filesystem::current_path("/"); break;
      case Parameters::Takes::rounding: std::fesetround(FE_UPWARD); break;
    }
  }

  void throw_in(Parameters::ThrowsIn place) const {
    if (parameters_.throws_in != place) return;
    if (parameters_.throws_number) throw 42;
    throw std::runtime_error{parameters_.throws_silently ? "" : "out of breath"};
  }

  void hang_in(Parameters::HangsIn place) const {
    while (parameters_.hangs_in == place) std::this_thread::sleep_for(std::chrono::seconds{1});
  }

  Parameters parameters_;
  std::uint64_t sent_ = 0;
  bool has_taken_ = false;
  Output<msg::Capture> beat_, order_;
};

}  // namespace armature::test::beat

ARMATURE_PLUGIN(armature::test::beat::Beat);
