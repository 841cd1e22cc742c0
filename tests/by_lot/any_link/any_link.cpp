// SPDX-License-Identifier: Apache-2.0
// The chronicle has a line per thing, times in s:
//   arm TIME q...                    every step, as the driver measures it
//   told TIME STAMP q... v...        arrives at the driver, newer than all before
//   link TIME way delay jitter loss doubles|cut   what it does from then on
//   task TIME state|detail           each change
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/chance.hpp"
#include "test_any_link_parameters.hpp"
#include "test_any_link_ports.hpp"

namespace armature::test::any_link {
namespace {

constexpr Duration kPeriod = seconds(0.001);

/// What one way of the link does now, anew every now and then.
class Weather {
 public:
  explicit Weather(std::uint64_t seed) : chance_{seed} {}

  /// True when it changes.
  bool change(double time_s, double calm_after_s) {
    if (time_s < until_s_) return false;
    const bool calm = time_s >= calm_after_s;
    until_s_ = calm ? 1e9 : time_s + (share() < 0.7 ? 0.02 + 0.3 * share() : 2 * share());
    const double kind = share();
    const auto rarely = [&](double probability, double most) {
      return share() < probability ? most * share() : 0;
    };
    delay_s_ = jitter_s_ = loss_ = doubles_ = 0;
    cut_ = !calm && kind < 0.2;
    if (calm || kind < 0.5) return true;
    delay_s_ = rarely(0.5, 0.05);
    jitter_s_ = rarely(0.5, share() < 0.5 ? 0.005 : 0.05);
    loss_ = rarely(0.5, 0.99);
    doubles_ = rarely(0.3, 0.5);
    return true;
  }

  bool loses() { return cut_ || share() < loss_; }
  bool doubles() { return share() < doubles_; }
  double delay_s() { return delay_s_ + jitter_s_ * share(); }
  std::string text() const {
    if (cut_) return "cut";
    return fmt::format("{:.3f} {:.3f} {:.2f} {:.2f}", delay_s_, jitter_s_, loss_, doubles_);
  }

 private:
  double share() { return chance_.share(); }

  Chance chance_;
  double until_s_ = 0.5;  // from the start of the run, which is calm
  double delay_s_ = 0, jitter_s_ = 0, loss_ = 0, doubles_ = 0;
  bool cut_ = false;
};

/// What is under way of one kind.
template <class Message>
class Line {
 public:
  void take(const Input<Message>& input, Weather& weather, Time now) {
    for (std::size_t i = 0; i < input.size(); ++i) {
      for (int copies = weather.doubles() ? 2 : 1; copies > 0; --copies) {
        if (weather.loses()) continue;
        under_way_.push_back({.due = now + seconds(weather.delay_s()), .message = input[i]});
      }
    }
  }

  template <class See>
  void give(Output<Message>& output, Time now, See see) {
    for (std::size_t i = 0; i < under_way_.size();) {
      if (under_way_[i].due > now) {
        ++i;
        continue;
      }
      see(under_way_[i].message);
      auto loan = output.loan();
      *loan = under_way_[i].message;
      loan.publish();
      under_way_.erase(under_way_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

 private:
  struct UnderWay {
    Time due;
    Message message;
  };
  std::vector<UnderWay> under_way_;
};

}  // namespace

class AnyLink final : public Component {
 public:
  explicit AnyLink(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        ports_{setup},
        there_{parameters_.seed},
        back_{parameters_.seed + 1'000'000},
        chronicle_{std::filesystem::path{parameters_.file}} {
    if (!chronicle_) throw SetupError("cannot write " + parameters_.file);
    setup.activate_every(kPeriod);
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    const double time_s = to_seconds(now - *start_);
    if (there_.change(time_s, parameters_.calm_after)) tell("there", there_, now);
    const bool changes = !parameters_.one_way && back_.change(time_s, parameters_.calm_after);
    if (changes) tell("back", back_, now);
    for (std::size_t i = 0; i < ports_.state.size(); ++i) see(ports_.state[i], now);
    for (std::size_t i = 0; i < ports_.true_js.size(); ++i) {
      write("arm {:.9f} {:.17g}", time_of(ports_.true_js[i]),
            fmt::join(ports_.true_js[i].position_(), " "));
    }
    commands_.take(ports_.servo_jp, there_, now);
    joints_.take(ports_.true_js, back_, now);
    states_.take(ports_.true_state, back_, now);
    commands_.give(ports_.driver_jp, now, [&](const msg::JointState& told) { see(told, now); });
    joints_.give(ports_.measured_js, now, [](const auto&) {});
    states_.give(ports_.operating_state, now, [](const auto&) {});
  }

 private:
  double time_of(const msg::JointState& message) const {
    return to_seconds(stamp_of(message.header_().stamp_()) - *start_);
  }

  void see(const msg::JointState& told, Time now) {
    const double stamp_s = time_of(told);
    if (stamp_s <= newest_s_) return;
    newest_s_ = stamp_s;
    write("told {:.9f} {:.9f} {:.17g} {:.17g}", to_seconds(now - *start_), stamp_s,
          fmt::join(told.position_(), " "), fmt::join(told.velocity_(), " "));
  }

  void see(const msg::TaskState& state, Time now) {
    std::string line = state.state_() + "|" + state.detail_();
    if (line != line_) write("task {:.4f} {}", to_seconds(now - *start_), line);
    line_ = std::move(line);
  }

  void tell(const char* way, const Weather& weather, Time now) {
    write("link {:.4f} {} {}", to_seconds(now - *start_), way, weather.text());
  }

  template <class... Values>
  void write(fmt::format_string<Values...> format, Values&&... values) {
    chronicle_ << fmt::format(format, std::forward<Values>(values)...) << '\n';
  }

  Parameters parameters_;
  Ports ports_;
  Weather there_, back_;
  Line<msg::JointState> commands_, joints_;
  Line<msg::String> states_;
  std::ofstream chronicle_;
  std::optional<Time> start_;
  double newest_s_ = -1;
  std::string line_;
};

}  // namespace armature::test::any_link

ARMATURE_PLUGIN(armature::test::any_link::AnyLink);
