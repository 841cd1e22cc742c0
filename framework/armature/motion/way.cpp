// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/way.hpp"

#include <fmt/core.h>

#include <string>
#include <utility>

namespace armature {
namespace {

constexpr std::size_t kKept = 4;       // drives: the newest may not have been taken over yet
constexpr double kSamePlace_s = 1e-6;  // as of retiming
constexpr double kSame = 1e-6;         // [rad] or [m], and of velocities

bool rests(const Trajectory& trajectory, double t) {
  return at_rest(state_at(trajectory.view(), t));
}

int stops_behind(const Trajectory& way, double place_s) {
  int stops = 0;
  for (double at = place_s; at < way.duration_s() - kSamePlace_s; ++stops) {
    at = next_rest_s(way, at);
  }
  return stops;
}

WayLegResult no_leg(std::string reason) {
  return tl::unexpected{PlanFailure{.stage = "path", .reason = std::move(reason)}};
}

}  // namespace

WayLeg Ways::keep(Drive drive) {
  WayLeg leg{drive.trajectory, stops_behind(drive.way.trajectory(), drive.to_s)};
  if (drives_.size() == kKept) drives_.pop_front();
  drives_.push_back(std::move(drive));
  return leg;
}

WayLegResult Ways::begin(const Plan& plan, bool stepwise) {
  const Trajectory& whole = plan.trajectory;
  const auto stops = std::ranges::count_if(plan.path, &PathSegment::stop_at_end);
  if (stepwise && stops_behind(whole, 0) < stops) {
    return tl::unexpected{
        PlanFailure{.stage = "trajectory",
                    .reason = fmt::format("it rests {} times, and its path stops {} times",
                                          stops_behind(whole, 0), stops)}};
  }
  const double end_s = whole.duration_s();
  const double to_s = stepwise ? next_rest_s(whole, 0) : end_s;
  Drive drive{.way = {.onward = whole, .back = reversed(whole)}, .to_s = to_s, .aims_s = to_s};
  drive.trajectory = to_s < end_s ? part(whole, 0, to_s) : whole;
  return keep(std::move(drive));
}

const Ways::Drive* Ways::find(const PlanRequest& request) const {
  for (auto drive = drives_.rbegin(); drive != drives_.rend(); ++drive) {
    const JointState there =
        drive->trajectory.at(drive->trajectory.start + (request.start - request.since));
    const bool same = (there.q - request.from.q).cwiseAbs().maxCoeff() < kSame &&
                      (there.v - request.from.v).cwiseAbs().maxCoeff() < kSame;
    if (same) return &*drive;
  }
  return nullptr;
}

Ways::Drive Ways::paused(const Drive& drive, double t) const {
  Drive next = drive;
  next.brakes = true;
  if (drive.brakes) {
    next.trajectory = part(drive.trajectory, t, drive.trajectory.duration_s());
    return next;
  }
  const double ready_s = std::max(t, drive.ramp_s);
  const Retimed stop = brake(drive.way.trajectory(), drive.place_at(ready_s), limits_);
  next.trajectory = followed_by(part(drive.trajectory, t, ready_s), stop.trajectory);
  next.to_s = stop.place_s;
  return next;
}

Expected<Ways::Drive> Ways::gone_on(const Drive& drive, bool back, bool stepwise) const {
  Drive next{.way = drive.way};
  next.way.forwards = !back;
  const Trajectory& way = next.way.trajectory();
  const bool turned = drive.way.forwards != next.way.forwards;
  next.from_s = turned ? way.duration_s() - drive.to_s : drive.to_s;
  const bool goes_on = drive.brakes && !turned;
  if (!goes_on && next.from_s > way.duration_s() - kSamePlace_s) {
    return refuse(back ? "the arm stands where its way began" : "nothing is left of the way");
  }
  const double stop_s = next_rest_s(way, next.from_s);
  next.to_s = goes_on ? drive.aims_s : stepwise ? stop_s : way.duration_s();
  next.aims_s = next.to_s;
  if (!rests(way, next.to_s)) return refuse("the way began while the arm moved");
  if (rests(way, next.from_s)) {
    next.ramp_end_s = next.from_s;
    next.trajectory = part(way, next.from_s, next.to_s);
    return next;
  }
  const Retimed on = speed_up(way, next.from_s, stop_s, limits_);
  next.ramp_s = on.ramp_s;
  next.ramp_end_s = on.place_s;
  next.trajectory = on.trajectory;
  if (stop_s < next.to_s) {
    next.trajectory = followed_by(on.trajectory, part(way, stop_s, next.to_s));
  }
  return next;
}

WayLegResult Ways::change(MotionMode mode, bool stepwise, const PlanRequest& request) {
  const Drive* drive = find(request);
  if (!drive) return no_leg("the arm is on no planned way");
  const double t = to_seconds(request.start - request.since);
  Drive next;
  if (mode == MotionMode::pause) {
    next = paused(*drive, t);
  } else {
    if (!at_rest(request.from)) return no_leg("the arm has not stopped yet");
    auto on = gone_on(*drive, mode == MotionMode::retrace, stepwise);
    if (!on) return no_leg(on.error().text);
    next = std::move(*on);
  }
  next.trajectory.start = request.start;
  next.trajectory.goal_id = request.goal_id;
  return keep(std::move(next));
}

}  // namespace armature
