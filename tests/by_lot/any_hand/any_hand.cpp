// SPDX-License-Identifier: Apache-2.0
// The chronicle has a line per thing, times in s:
//   arm TIME q...               every step of the follower
//   clutch TIME 0|1             each change of what is told of it
//   stop TIME; rearmed TIME     something stops the arms; they may move again
//   wild TIME motion fault      what the hand does from then on, and what becomes of its poses
//   calm TIME                   it behaves well from then on, for 4 s: rests with the clutch open,
//                               closes it, and then goes 8 mm of the follower's tip towards home
//   closed TIME m               by which the tip has moved since the clutch closed on a hand at
//   rest followed TIME m             by which it is then beside where the hand has led it none TIME
//   what              a number that is none task TIME state|detail      each change
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "armature/kinds/pose_in_base.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/std_msgs.hpp"
#include "armature/robot/trajectories/quintic.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/chance.hpp"
#include "test_any_hand_parameters.hpp"
#include "test_any_hand_ports.hpp"

namespace armature::test::any_hand {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod_s = 0.001;
constexpr double kCloses_s = 1, kSetsOut_s = 1.5, kArrives_s = 3.5, kEnds_s = 4;  // of a calm time

enum class Way { rest, go, tremble, jump, spin, jerk, count };
enum class Fault {
  none,
  late,
  doubled,
  disordered,
  lost,
  not_a_number,
  no_unit,
  ahead,
  same,
  count
};

}  // namespace

class AnyHand final : public Component {
 public:
  explicit AnyHand(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        ports_{setup},
        chance_{parameters_.seed},
        chronicle_{std::filesystem::path{parameters_.file}} {
    if (!chronicle_) throw SetupError("cannot write " + parameters_.file);
    setup.activate_every(seconds(kPeriod_s));
  }

  void step(Time now) override {
    if (!start_) start_ = now;
    now_ = now;
    watch();
    if (now >= hold_at_) {
      hold_at_ = now + seconds(0.02);
      tell(ports_.hold_to_run, !lets_go_);
    }
    if (!has_it_) return pass_on();
    if (time() >= until_s_) begin_phase();
    if (calm_from_) {
      behave_well();
    } else {
      do_anything();
    }
    tell_pose();
  }

 private:
  double share() { return chance_.share(); }
  bool happens(double probability) { return chance_.happens(probability); }
  double about(double most) { return most * (2 * share() - 1); }
  Vector3d any_vector(double most) {
    return Vector3d{about(1), about(1), about(1)}.normalized() * most * share();
  }
  template <class Kind>
  Kind any() {
    return static_cast<Kind>(static_cast<int>(share() * static_cast<double>(Kind::count)));
  }
  double time() const { return to_seconds(now_ - *start_); }

  void watch() {
    for (std::size_t i = 0; i < ports_.follower_js.size(); ++i) {
      const msg::JointState& arm = ports_.follower_js[i];
      write("arm {:.9f} {:.17g}", to_seconds(stamp_of(arm.header_().stamp_()) - *start_),
            fmt::join(arm.position_(), " "));
    }
    for (std::size_t i = 0; i < ports_.goal.size(); ++i) {
      const msg::MotionGoal& goal = ports_.goal[i];
      const auto& q = goal.orientation_();
      const double sum = to_eigen(goal.position_()).sum() + to_eigen(goal.velocity_()).sum() +
                         to_eigen(goal.angular_velocity_()).sum() + q.x_() + q.y_() + q.z_() +
                         q.w_();
      if (!std::isfinite(sum)) write("none {:.3f} goal {}", time(), goal.goal_id_());
    }
    for (std::size_t i = 0; i < ports_.state.size(); ++i) {
      const msg::TaskState& state = ports_.state[i];
      std::string line = state.state_() + "|" + state.detail_();
      if (line != line_) write("task {:.3f} {}", time(), line);
      line_ = std::move(line);
      has_it_ = has_it_ || state.state_() == "aligned";
    }
  }

  /// The leader has not been given to the hand yet.
  void pass_on() {
    if (!ports_.true_cp.fresh()) return;
    auto loan = ports_.leader_cp.loan();
    *loan = *ports_.true_cp.latest();
    loan.publish();
    hand_ = pose_in_base(*ports_.true_cp.latest(), "the leader").value();
    if (ports_.follower_cp.latest()) home_ = tip();
  }

  Vector3d tip() const { return to_eigen(ports_.follower_cp.latest()->pose_().position_()); }

  void begin_phase() {
    const bool was_calm = std::exchange(calm_from_, std::nullopt).has_value();
    if (!was_calm && wild_ > 0 && --wild_ == 0) return begin_calm();
    if (wild_ == 0) wild_ = 2 + static_cast<int>(4 * share());
    way_ = any<Way>();
    fault_ = happens(0.5) ? Fault::none : any<Fault>();
    const double longest_s = fault_ == Fault::lost && happens(0.3) ? 3 : happens(0.3) ? 0.1 : 1;
    until_s_ = time() + 0.01 + longest_s * share();
    write("wild {:.3f} {} {}", time(), static_cast<int>(way_), static_cast<int>(fault_));
    velocity_ = any_vector(happens(0.3) ? 1.9 : 0.2);
    turn_ = any_vector(way_ == Way::spin ? 19 : 2);
    tremor_hz_ = 3 + 12 * share();
    if (way_ == Way::jump) {
      hand_.translation() += any_vector(1);
      hand_.rotate(Eigen::AngleAxisd{std::numbers::pi * share(), any_vector(1).normalized()});
    }
    share_lost_ = happens(0.5) ? 1 : share();
    closed_ = happens(0.7);
    chatters_ = happens(0.2) ? 0.5 * share() : 0;
    clutch_silent_ = happens(0.1);
    if (happens(0.15)) {
      write("stop {:.3f}", time());
      if (happens(0.5)) {
        tell(ports_.stop, true);
      } else {
        lets_go_ = true;
        tell(ports_.hold_to_run, false);
      }
    }
    if (happens(0.3)) rearm();
  }

  void rearm() {
    if (std::exchange(lets_go_, false)) tell(ports_.hold_to_run, true);
    tell(ports_.rearm, true);
    write("rearmed {:.3f}", time());
  }

  void begin_calm() {
    calm_from_ = time();
    until_s_ = time() + kEnds_s;
    fault_ = Fault::none;
    way_ = Way::rest;
    clutch_silent_ = false;
    under_way_.clear();
    write("calm {:.3f}", time());
    rearmed_s_ = 0;
    sets_out_ = followed_ = false;
  }

  void behave_well() {
    const double since_s = time() - *calm_from_;
    if (since_s < 0.8 && since_s >= rearmed_s_) {
      rearmed_s_ = since_s + 0.3;
      rearm();
    }
    const bool closes = since_s >= kCloses_s && !closed_;
    // The first goal behind a stop between two goals fails: the clutch is closed twice.
    tell_clutch(since_s >= kCloses_s || (since_s >= 0.85 && since_s < 0.9));
    if (closes) from_ = tip();
    if (since_s >= kSetsOut_s && !std::exchange(sets_out_, true)) {
      write("closed {:.3f} {:.9f}", time(), (tip() - from_).norm());
      const Vector3d home = home_ - tip();
      const Vector3d way =
          0.008 * (home.norm() > 0.01 ? Vector3d{home.normalized()} : Vector3d::UnitZ());
      from_ = tip();
      to_ = from_ + way;
      hand_from_ = hand_.translation();
      const auto console = pose_in_base(*ports_.console.latest(), "the console").value();
      hand_way_ = console.linear().transpose() * way / parameters_.scale;
    }
    if (since_s >= kSetsOut_s) {
      const double part = std::min(1.0, (since_s - kSetsOut_s) / (kArrives_s - kSetsOut_s));
      hand_.translation() =
          hand_from_ + Quintic::between({0, 0, 0}, {1, 0, 0}, 1).position(part) * hand_way_;
    }
    if (since_s >= kArrives_s + 0.4 && !std::exchange(followed_, true)) {
      write("followed {:.3f} {:.9f}", time(), (tip() - to_).norm());
    }
  }

  void do_anything() {
    const bool goes = way_ == Way::go || way_ == Way::spin || way_ == Way::jerk;
    if (way_ == Way::jerk) velocity_ = any_vector(1.9);
    if (goes) {
      hand_.translation() += velocity_ * kPeriod_s;
      const double angle = turn_.norm() * kPeriod_s;
      hand_.linear() = Eigen::AngleAxisd{angle, turn_.normalized()} * hand_.linear();
    }
    if (way_ == Way::tremble) {
      const double omega = 2 * std::numbers::pi * tremor_hz_;
      hand_.translation() +=
          0.003 * omega * std::cos(omega * time()) * kPeriod_s * turn_.normalized();
    }
    if (happens(chatters_)) closed_ = !closed_;
    if (clutch_silent_) return;
    if (happens(0.001)) tell_clutch(!closed_);  // and at once again
    tell_clutch(closed_);
  }

  void tell_clutch(bool closed) {
    if (!told_ || *told_ != closed) write("clutch {:.3f} {}", time(), closed ? 1 : 0);
    told_ = closed_ = closed;
    tell(ports_.clutch, closed);
  }

  void tell_pose() {
    const auto is = [this](Fault fault) { return fault_ == fault; };
    msg::PoseStamped message;
    Time stamp = now_ + seconds(is(Fault::ahead) ? 0.3 * share() : 0);
    if (is(Fault::same)) stamp = last_stamp_;
    last_stamp_ = stamp;
    write_header(message.header_(), stamp, "base");
    assign(message.pose_(), hand_);
    const double none = std::numeric_limits<double>::quiet_NaN();
    if (is(Fault::not_a_number) && happens(0.3)) message.pose_().position_().y_(none);
    if (is(Fault::not_a_number) && happens(0.3)) message.pose_().orientation_().x_(none);
    if (is(Fault::no_unit)) message.pose_().orientation_().w_(3 * share());
    if (is(Fault::lost) && happens(share_lost_)) return;
    const double late_s = is(Fault::late)         ? 0.05 * share_lost_
                          : is(Fault::disordered) ? 0.02 * share()
                                                  : 0;
    under_way_.emplace_back(now_ + seconds(late_s), message);
    if (is(Fault::doubled)) under_way_.emplace_back(now_ + seconds(0.01 * share()), message);
    for (std::size_t i = 0; i < under_way_.size();) {
      if (under_way_[i].first > now_) {
        ++i;
        continue;
      }
      auto loan = ports_.leader_cp.loan();
      *loan = under_way_[i].second;
      loan.publish();
      under_way_.erase(under_way_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  static void tell(Output<msg::Bool>& output, bool told) {
    auto loan = output.loan();
    loan->data_(told);
    loan.publish();
  }

  template <class... Values>
  void write(fmt::format_string<Values...> format, Values&&... values) {
    chronicle_ << fmt::format(format, std::forward<Values>(values)...) << '\n';
  }

  Parameters parameters_;
  Ports ports_;
  Chance chance_;
  std::ofstream chronicle_;
  std::optional<Time> start_;
  Time now_, hold_at_, last_stamp_;
  std::string line_;
  bool has_it_ = false, lets_go_ = false;
  Eigen::Isometry3d hand_ = Eigen::Isometry3d::Identity();  // in the leader's base
  // What it does now.
  Way way_ = Way::rest;
  Fault fault_ = Fault::none;
  int wild_ = 0;  // so many phases until it is calm
  double until_s_ = 0, tremor_hz_ = 3, share_lost_ = 0, chatters_ = 0;
  Vector3d velocity_ = Vector3d::Zero(), turn_ = Vector3d::UnitX();
  bool closed_ = false, clutch_silent_ = false;
  std::optional<bool> told_;  // of the clutch
  std::vector<std::pair<Time, msg::PoseStamped>> under_way_;
  // While it is calm: of the follower's tip and of the hand.
  std::optional<double> calm_from_;
  double rearmed_s_ = 0;
  bool sets_out_ = false, followed_ = false;
  Vector3d home_ = Vector3d::Zero(), from_ = Vector3d::Zero(), to_ = Vector3d::Zero();
  Vector3d hand_from_ = Vector3d::Zero(), hand_way_ = Vector3d::Zero();
};

}  // namespace armature::test::any_hand

ARMATURE_PLUGIN(armature::test::any_hand::AnyHand);
