// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/tracking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "armature/motion/missed_pose.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/values/guarded.hpp"

namespace armature {
namespace {

constexpr double kHorizonGrowth = 1.25;
constexpr double kLongestHorizon = 20.0;    // [s]
constexpr double kLongestPrediction = 1.0;  // [s] a velocity is not trusted longer
constexpr double kTimePerAttempt_s = 0.0025;
constexpr double kFollowing = 0.25;     // [s] nor that of a target that is followed behind
constexpr double kDifference_s = 2e-3;  // of the difference quotients

/// How much of its limit the joint takes that takes most of it.
double share_of(const JointVector& limits, const JointVector& rates) {
  return rates.cwiseQuotient(limits).cwiseAbs().maxCoeff();
}

/// [m/s] of the tool's origin.
double tool_speed(const RobotModel& model, const JointState& state) {
  const auto now = forward_kinematics_with_jacobian(model, state.q, model.tool());
  return (now.jacobian.topRows<3>() * state.v).norm();
}

/// Where the tool's speed is looked at, in parts of the way: evenly, and closer at its beginning,
/// which is what the arm goes before the next target comes.
constexpr std::array kLooks{0.,     1. / 256, 1. / 64, 1. / 16, 1. / 8, 2. / 8,
                            3. / 8, 4. / 8,   5. / 8,  6. / 8,  7. / 8, 1.};

/// Where the parabola through three points has its vertex.
double vertex(const std::array<double, 3>& x, const std::array<double, 3>& y) {
  const double left = (y[1] - y[0]) / (x[1] - x[0]), right = (y[2] - y[1]) / (x[2] - x[1]);
  return 0.5 * (x[0] + x[1] - left * (x[2] - x[0]) / (right - left));
}

/// [m/s] The largest speed of the tool's origin on the way to the meeting point. It is smooth:
/// between the looks around the highest one a parabola finds the peak.
double peak_tool_speed(const RobotModel& model, const TrajectoryView& way, double horizon_s) {
  const auto speed_at = [&](double part) {
    return tool_speed(model, way.at(way.start + seconds(part * horizon_s)));
  };
  std::array<double, kLooks.size()> speeds;
  std::ranges::transform(kLooks, speeds.begin(), speed_at);
  const auto highest = std::ranges::max_element(speeds);
  const auto i = static_cast<std::size_t>(
      std::clamp(highest, speeds.begin() + 1, speeds.end() - 2) - speeds.begin());
  const double between =
      vertex({kLooks[i - 1], kLooks[i], kLooks[i + 1]}, {speeds[i - 1], speeds[i], speeds[i + 1]});
  if (!(between > kLooks[i - 1] && between < kLooks[i + 1])) return *highest;
  return std::max(*highest, speed_at(between));
}

/// Speeds of a joint or of the tool on a way.
struct Speeds {
  double first, peak, last;
};

/// How much longer a way should take whose peak is beyond `limit`. What the target moves by itself
/// does not fall with the time: its speed, and half of what it is faster than the arm now, which
/// the arm has to make up for.
double longer_for(const Speeds& speeds, double limit) {
  const double ahead = std::max(0.0, speeds.last - speeds.first);
  const double lasting = std::min(speeds.last + 0.5 * ahead, kMeetingUse * limit);
  return (speeds.peak - lasting) / (limit - lasting);
}

/// How many growths, at least one, make a horizon `longer` times as long; less what the limits
/// tolerate.
int growths_for(double longer) {
  constexpr double kTolerated = 1e-3;
  const double growths = std::log(longer * (1 - kTolerated)) / std::log(kHorizonGrowth);
  return static_cast<int>(std::min(std::max(1.0, std::ceil(growths)), 100.0));  // of anything
}

}  // namespace

Tracker::Tracker(const RobotModel& model, const MotionLimits& limits, Slot<const IkSolver> ik,
                 const TrackingOptions& options)
    : model_{model},
      limits_{limits},
      ik_{ik},
      options_{options},
      horizons_{1 + static_cast<int>(std::log(kLongestHorizon / options.shortest_horizon_s) /
                                     std::log(kHorizonGrowth))} {
  begin_search({0, horizons_});
  if (options.pivot) pivot_.emplace(model, *options.pivot);
}

/// The branch nearest to `near`; false, and the defect says why, when none is within limits or it
/// misses the pose.
bool Tracker::solve(const ToolPose& pose, const JointVector& near, JointVector& q) {
  const IkGoal goal{.pose = pose};
  const auto status = guarded([&] {
    IkState state{.last_redundancy = ik_->redundancy_of(near)};
    return ik_->solve(goal, near, branches_, state);
  });
  const bool reached = status && reaches(*status);
  if (const IkBranch* chosen = reached ? nearest_branch(branches_, near, model_) : nullptr) {
    q = chosen->q;
    unwind(model_, near, q);
    const ReasonText missed = missed_by(model_, q, pose);
    if (missed.empty()) return true;
    defect_ = ReasonText::format("the goal: the branch '{}' misses it by {}", chosen->label,
                                 missed.view());
    return false;
  }
  const ReasonText why = status ? reason_of(*status) : ReasonText{status.error().text};
  defect_ = ReasonText::format("the goal: {}", why.view());
  return false;
}

/// Where the joints shall be after `horizon_s`, and how they move there.
bool Tracker::meeting_point(const JointState& from, double horizon_s, JointState& meet) {
  if (pivots()) return pivoted_meeting_point(from, horizon_s, meet);
  const double ahead_s = std::min(horizon_s, trusted_s_);
  if (!solve(target_.after(ahead_s), from.q, meet.q)) return false;
  meet.v = meet.a = JointVector::Zero(meet.q.size());
  if (horizon_s <= trusted_s_) move_along(ahead_s, meet);
  return true;
}

bool Tracker::reach(const ToolPose& pose, const JointVector& near, JointVector& q) {
  return pivots() ? solve_pivoted(pose, near, q) : solve(pose, near, q);
}

/// The velocity and the acceleration that the target's own motion asks of the joints at meet.q.
/// False where it leaves the reach.
bool Tracker::target_rates(double ahead_s, JointState& meet) {
  JointVector before, next;
  const bool goes_on = reach(target_.after(ahead_s - kDifference_s), meet.q, before) &&
                       reach(target_.after(ahead_s + kDifference_s), meet.q, next);
  if (!goes_on) return false;
  meet.v = (next - before) / (2 * kDifference_s);
  meet.a = (next - 2 * meet.q + before) / (kDifference_s * kDifference_s);
  return true;
}

/// With the target, as far as the limits allow. A target that leaves the reach is waited for at the
/// border, at rest.
void Tracker::move_along(double ahead_s, JointState& meet) {
  if (!target_.moves()) return;
  JointState moving{.q = meet.q, .v = {}, .a = {}};
  if (!target_rates(ahead_s, moving)) return;
  const double slower = std::min(1.0, kMeetingUse / share_of(limits_.max_velocity, moving.v));
  const double calmer = std::min(1.0, kMeetingUse / share_of(limits_.max_acceleration, moving.a));
  moving.v *= slower;
  moving.a *= std::min(calmer, slower * slower);
  JointState rest;
  if (!pivots() || rest_behind(moving, stop_time_s(moving), rest)) meet = moving;
}

/// Empty, or which joint the way to the meeting point would jerk beyond its limit.
ReasonText Tracker::jerk_defect(const ShortTrajectory& way, double horizon_s) const {
  for (int i = 0; i < options_.max_jerk.size(); ++i) {
    const double peak = peak_jerk(way.view().piece(0, i), horizon_s);
    if (peak <= options_.max_jerk[i]) continue;
    const auto joint = static_cast<std::size_t>(model_.independent_joint(i));
    return ReasonText::format("joint {} would need a jerk of {:.4g}, its limit is {:.4g}",
                              model_.joints()[joint].name, peak, options_.max_jerk[i]);
  }
  return {};
}

ReasonText Tracker::speed_defect(double speed) const {
  return ReasonText::format("the tool would need {:.4g} m/s, its limit is {:.4g} m/s", speed,
                            options_.max_tool_speed);
}

/// How much longer a way that breaks limits of the joints should take: its velocities fall with the
/// time that it takes, its accelerations with the square, its jerks with the cube of that.
double Tracker::longer_for_joints(const ShortTrajectory& way, double horizon_s) const {
  double longer = 1;
  for (int i = 0; i < way.dof; ++i) {
    const Quintic quintic = way.view().piece(0, i);
    const QuinticPeaks peak = peaks(quintic, horizon_s);
    longer = std::max({longer,
                       longer_for({std::abs(quintic.velocity(0)), peak.velocity,
                                   std::abs(quintic.velocity(horizon_s))},
                                  limits_.max_velocity[i]),
                       std::sqrt(peak.acceleration / limits_.max_acceleration[i])});
    if (options_.max_jerk.size() == 0) continue;
    longer = std::max(longer, std::cbrt(peak_jerk(quintic, horizon_s) / options_.max_jerk[i]));
  }
  return longer;
}

/// Behind a meeting point that is passed moving.
bool Tracker::append_stop(const JointState& meet, ShortTrajectory& out) {
  const Time end = out.view().end();
  if (!pivots()) {
    return out.append(
        short_stop_from(meet, limits_.max_velocity, limits_.max_acceleration, end, out.goal_id));
  }
  JointState rest;
  const double stop_s = stop_time_s(meet);
  return rest_behind(meet, stop_s, rest) &&
         out.append(short_quintic(meet, rest, end, stop_s, out.goal_id));
}

/// The defect says why a target is not met. What costs least is looked at first.
Tracker::Attempt Tracker::attempt(const JointState& from, Time start, double horizon_s,
                                  ShortTrajectory& out) {
  using enum Attempt::Outcome;
  ++attempts_;
  JointState meet;
  if (!meeting_point(from, horizon_s, meet)) return {out_of_reach};
  const bool limited = std::isfinite(options_.max_tool_speed);
  if (const double speed = limited ? tool_speed(model_, meet) : 0; speed > allowed_speed_) {
    defect_ = speed_defect(speed);
    return {too_short, trusted_s_ / horizon_s};  // behind which it ends at rest
  }
  out = short_quintic(from, meet, start, horizon_s, goal_id_);
  if (!at_rest(meet) && !append_stop(meet, out)) return {out_of_reach};
  defect_ = jerk_defect(out, horizon_s);
  if (defect_.empty()) defect_ = trajectory_defect(out.view(), model_, limits_, from, start);
  if (!defect_.empty()) return {too_short, longer_for_joints(out, horizon_s)};
  // A longer way would leave the incision farther.
  if (pivots() && !keeps_to_incision(out, from)) return {out_of_reach};
  const double speed = limited ? peak_tool_speed(model_, out.view(), horizon_s) : 0;
  if (speed <= allowed_speed_) return {met};
  defect_ = speed_defect(speed);
  return {too_short,
          longer_for({tool_speed(model_, from), speed, tool_speed(model_, meet)}, allowed_speed_)};
}

void Tracker::begin_search(Horizons among) {
  search_.among = search_.left = among;
  search_.next = among.begin;
  search_.found.reset();
  search_.last_resort = false;
  search_.by_limits.clear();
  search_.by_reach.clear();
}

/// What holds for every horizon of a call.
void Tracker::look_around(const MotionGoal& goal, const JointState& from, Time start) {
  target_.see(goal, start);
  last_start_ = start;
  goal_id_ = goal.id;
  attempts_ = 0;
  waits_for_.clear();
  allowed_speed_ = options_.max_tool_speed;
  if (std::isfinite(allowed_speed_)) {
    allowed_speed_ = std::max(allowed_speed_, tool_speed(model_, from)) * (1 + 1e-9);
  }
  // One that is not caught up with is followed to where it is, not to where it will have gone.
  const bool too_fast = goal.velocity.norm() > kMeetingUse * options_.max_tool_speed;
  trusted_s_ = under_way_ && too_fast ? kFollowing : kLongestPrediction;
}

TrackingFailure Tracker::begin(const MotionGoal& goal, const JointState& from, Time start,
                               ShortTrajectory& out) {
  under_way_ = keeps_near_ = false;
  look_around(goal, from, start);
  begin_search({0, horizons_});
  while (attempts_ < kMaxAttempts && !search_.left.empty()) try_next(from, start, out);
  if (pivots()) return wait_at_border(outcome(), from, start, out);
  return outcome();
}

TrackingFailure Tracker::follow(const MotionGoal& goal, const JointState& from, Time start,
                                ShortTrajectory& out) {
  under_way_ = true;
  const auto passed = (start - last_start_) / seconds(kTimePerAttempt_s);
  const int affordable = static_cast<int>(std::clamp<std::int64_t>(passed, 1, kMaxAttempts));
  look_around(goal, from, start);
  while (attempts_ < affordable && !search_.left.empty()) try_next(from, start, out);
  keeps_near_ = keeps_near(from, start, out);
  if (keeps_near_) return {};
  if (pivots()) return wait_at_border(outcome(), from, start, out);
  return outcome();
}

double Tracker::horizon_s(int growths) const {
  return options_.shortest_horizon_s * std::pow(kHorizonGrowth, growths);
}

void Tracker::try_next(const JointState& from, Time start, ShortTrajectory& out) {
  using enum Attempt::Outcome;
  auto& [among, left, next, found, last_resort, by_limits, by_reach] = search_;
  const double horizon_s = this->horizon_s(next);
  const Attempt tried = attempt(from, start, horizon_s, found ? way_ : out);
  switch (tried.outcome) {
    case too_short:
      by_limits = defect_;
      left.begin = next + 1;
      break;
    case out_of_reach:
      by_reach = ReasonText::format("; {:.2g} s ahead {}", horizon_s, defect_.view());
      left.end = next;
      break;
    case met:
      if (found) out = way_;
      left.end = next;
      found = next;
  }
  const bool bounded = left.end < among.end;  // by one that is met or out of reach
  // The last horizon, one above the first that is tried, mostly does still: no leap over it.
  const int leap = under_way_ && next == among.begin ? 1 : growths_for(tried.longer);
  next = bounded ? (left.begin + left.end) / 2 : std::min(next + leap, among.end - 1);
  // Better a slow way than none.
  last_resort = !found && !bounded && attempts_ + 1 == kMaxAttempts;
  if (last_resort) next = among.end - 1;
}

/// Of a call; and prepares the search of the next one.
TrackingFailure Tracker::outcome() {
  if (search_.found) {
    // A last resort is no horizon to go on from: shorter ones are sought anew.
    const int from = search_.last_resort ? 0 : std::max(0, *search_.found - 1);
    begin_search({from, horizons_});
    return {};
  }
  const auto& [among, left, next, found, last_resort, by_limits, by_reach] = search_;
  const Horizons below{0, among.begin};
  const bool over = left.empty() && (below.empty() || !under_way_);
  TrackingFailure failure{"ik", defect_};
  if (!over || !by_limits.empty()) {
    failure = {"trajectory", ReasonText::format("tracking within limits: {}{}", by_limits.view(),
                                                by_reach.view())};
  }
  // Where the target leaves the reach soon only a short horizon may do.
  if (left.empty()) begin_search(over ? Horizons{0, horizons_} : below);
  return failure;
}

}  // namespace armature
