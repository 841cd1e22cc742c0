// SPDX-License-Identifier: Apache-2.0
#include "armature/motion/reference.hpp"

#include <algorithm>
#include <utility>

namespace armature {

void Reference::start(const JointVector& q, Time now) {
  if (count_ == 1) {
    const JointState holds = at(now);
    if (holds.q == q && at_rest(holds)) return;
  }
  count_ = 0;
  splice(short_hold_at(q, now, 0));
}

void Reference::forget() {
  while (count_ > 0) entries_[--count_].sample = {};
  ++serial_;
}

Reference::Entry& Reference::make_room(Time start) {
  ++serial_;
  while (count_ > 0 && entries_[count_ - 1].start() >= start) {
    entries_[--count_].sample = {};
  }
  // Between two calls of `advance` at most three are spliced at instants that differ.
  if (count_ == entries_.size()) --count_;
  return entries_[count_++];
}

void Reference::splice(const ShortTrajectory& next) {
  Entry& entry = make_room(next.start);
  entry.own = next;
  entry.sample = {};
  entry.is_own = true;
  entry.slows_from.reset();
}

void Reference::splice(const TrajectoryView& next, SampleRef sample) {
  Entry& entry = make_room(next.start);
  entry.elsewhere = next;
  entry.sample = std::move(sample);
  entry.is_own = false;
  entry.slows_from.reset();
}

void Reference::postpone_last(Time start) {
  ++serial_;
  Entry& last = entries_[count_ - 1];
  (last.is_own ? last.own.start : last.elsewhere.start) = start;
}

void Reference::advance(Time now) {
  std::size_t past = 0;
  while (past + 1 < count_ && entries_[past + 1].start() <= now) ++past;
  if (past == 0) return;
  for (std::size_t i = past; i < count_; ++i) std::swap(entries_[i - past], entries_[i]);
  count_ -= past;
  for (std::size_t i = count_; i < entries_.size(); ++i) entries_[i].sample = {};
}

std::size_t Reference::index_at(Time time) const {
  std::size_t holds = 0;
  while (holds + 1 < count_ && entries_[holds + 1].start() <= time) ++holds;
  return holds;
}

Time Reference::Entry::end() const {
  if (!slows_from) return view().end();
  return *slows_from + seconds(slowing.duration_s()) + Duration{1};  // rounded up
}

JointState Reference::Entry::at(Time time) const {
  if (!slows_from || time <= *slows_from) return view().at(time);
  return slowing.at(view(), to_seconds(time - *slows_from));
}

bool Reference::slow_down(Time now, const MotionLimits& limits) {
  const std::size_t holds = index_at(now);
  Entry& entry = entries_[holds];
  if (entry.slows_from) {
    drop_behind(holds);
    return true;
  }
  if (!entry.slowing.begin(entry.view(), to_seconds(now - entry.start()), limits)) return false;
  entry.slows_from = now;
  drop_behind(holds);
  return true;
}

void Reference::drop_behind(std::size_t holds) {
  ++serial_;
  while (count_ > holds + 1) entries_[--count_].sample = {};
}

}  // namespace armature
