// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <array>
#include <csignal>
#include <stdexcept>

#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "test_reader_parameters.hpp"

namespace armature::test::reader {

class Reader final : public Component {
 public:
  explicit Reader(Setup& setup)
      : Component{setup},
        device_{Parameters::read(setup.params()).device},
        note_{setup.output<msg::String>("note")},
        readings_{setup.driver_thread<int>(8, [this] { read(); })} {
    if (pipe(pipe_.data()) != 0) throw std::runtime_error{"there is no pipe"};
  }

  void step(Time) override {
    while (const auto reading = readings_.take()) {
      auto note = note_.loan();
      note->data_() = "reading " + std::to_string(reading->sample);
      note.publish();
      ++notes_;
    }
  }
  void stop(Time) override {
    if (device_ == Parameters::Device::is_closed) close(pipe_[1]);
  }
  void summarize(Summary& summary) const override { summary.metric("notes", "readings", notes_); }

 private:
  void read() {
    using enum Parameters::Device;
    if (device_ == throws) throw std::runtime_error{"the cable is out"};
    if (device_ == crashes) std::raise(SIGSEGV);
    for (int i = 0; !readings_.stopping(); ++i) {
      if (device_ != talks) {
        char byte = 0;
        if (::read(pipe_[0], &byte, 1) == 0) return;  // the other end is closed
      } else if (readings_.sleep_for(seconds(0.02))) {
        readings_.push(readings_.now(), i);
      }
    }
  }

  Parameters::Device device_;
  std::array<int, 2> pipe_{};
  int notes_ = 0;
  Output<msg::String> note_;
  DriverQueue<int>& readings_;
};

}  // namespace armature::test::reader

ARMATURE_PLUGIN(armature::test::reader::Reader);
