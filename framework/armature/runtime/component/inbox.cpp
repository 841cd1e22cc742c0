// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component/inbox.hpp"

#include <algorithm>
#include <mutex>
#include <utility>

#include "armature/runtime/component/ports.hpp"

namespace armature {
InputPort::InputPort(PortSpec spec, const MessageType& type, Inbox& inbox)
    : spec_{std::move(spec)},
      type_{&type},
      inbox_{&inbox},
      is_answered_{!spec_.feedback},
      capacity_{static_cast<std::size_t>(spec_.queue.value_or(1))} {
  waiting_.reserve(capacity_);
  shown_.reserve(capacity_);
  if (spec_.join) unmatched_.reserve(kJoinDepth);
}

void InputPort::deliver(const SampleRef& sample) {
  if (const auto lost = sample.info().lost_before) inbox_->count_lost(lost);
  if (!heeds_ || heeds_(sample.message())) inbox_->arrived(*this, sample);
}

void InputPort::keep(const SampleRef& sample) {
  if (waiting_.size() == capacity_) {
    waiting_.erase(waiting_.begin());
    if (spec_.queue) ++inbox_->dropped_;
  }
  waiting_.push_back(sample);
}

Time InputPort::stamp_of(const SampleRef& sample) const {
  return type_->stamp ? type_->stamp(sample.message()) : sample.info().published;
}

void InputPort::show(Time now) {
  fresh_ = !waiting_.empty();
  if (spec_.queue || fresh_) {
    std::swap(shown_, waiting_);
    waiting_.clear();
  }
  std::erase_if(shown_, [&](const SampleRef& sample) {
    return is_too_far_ahead(sample, now) ||
           (spec_.max_age && now - judged_time(sample) > *spec_.max_age);
  });
  fresh_ = fresh_ && !shown_.empty();
}

bool InputPort::is_too_far_ahead(const SampleRef& sample, Time now) {
  const Duration ahead = judged_time(sample) - now;
  if (ahead <= spec_.max_ahead) return false;
  inbox_->ahead_ = {.samples = inbox_->ahead_.samples + 1, .port = this, .by = ahead};
  return true;
}

Measurement InputPort::oldest_measurement() const {
  if (!fresh_ || !is_answered_) return {};
  if (source_ >= 0) return {.source = source_, .at = stamp_of(shown_.front())};
  Measurement oldest;
  for (const SampleRef& sample : shown_) {
    const Measurement& answered = sample.info().answers_to;
    const bool is_older = oldest.source < 0 || answered.at < oldest.at;
    if (answered.source >= 0 && is_older) oldest = answered;
  }
  return oldest;
}

InputPort& Inbox::add(PortSpec spec, const MessageType& type) {
  ports_.push_back(std::make_unique<InputPort>(std::move(spec), type, *this));
  InputPort& port = *ports_.back();
  if (port.spec_.join) joined_.push_back(&port);
  return port;
}

void Inbox::count_lost(std::uint64_t samples) {
  const std::scoped_lock lock{mutex_};
  if (!closed_) dropped_ += samples;
}

void Inbox::arrived(InputPort& port, const SampleRef& sample) {
  bool triggered = false;
  {
    const std::scoped_lock lock{mutex_};
    if (closed_) return;
    if (port.spec_.join) {
      if (port.unmatched_.size() == InputPort::kJoinDepth)
        port.unmatched_.erase(port.unmatched_.begin());
      port.unmatched_.push_back(sample);
      triggered = match_joined();
    } else {
      port.keep(sample);
      triggered = port.spec_.trigger;
    }
  }
  if (triggered) on_trigger_();
}

/// Moves the newest set of equal stamps to the waiting samples of its ports.
bool Inbox::match_joined() {
  const auto find = [](InputPort& port, Time stamp) {
    return std::find_if(port.unmatched_.begin(), port.unmatched_.end(),
                        [&](const SampleRef& sample) { return port.stamp_of(sample) == stamp; });
  };
  const auto& first = joined_.front()->unmatched_;
  for (auto newest = first.rbegin(); newest != first.rend(); ++newest) {
    const Time stamp = joined_.front()->stamp_of(*newest);
    if (!std::all_of(joined_.begin(), joined_.end(), [&](InputPort* port) {
          return find(*port, stamp) != port->unmatched_.end();
        })) {
      continue;
    }
    for (InputPort* port : joined_) {
      const auto match = find(*port, stamp);
      port->keep(*match);
      port->unmatched_.erase(port->unmatched_.begin(), std::next(match));
    }
    return true;
  }
  return false;
}

void Inbox::show(Time now) {
  const std::scoped_lock lock{mutex_};
  Measurement oldest;
  int input = 0;
  for (const auto& port : ports_) {
    if (tap_ && !port->waiting_.empty()) tap_->read(input, port->waiting_);
    ++input;
    port->show(now);
    const Measurement measured = port->oldest_measurement();
    const bool is_older = oldest.source < 0 || measured.at < oldest.at;
    if (measured.source >= 0 && is_older) oldest = measured;
  }
  source_.store(oldest.source, std::memory_order_relaxed);
  measured_at_ns_.store(oldest.at.ns, std::memory_order_relaxed);
}

void Inbox::put(InputPort& port, const SampleRef& sample) {
  const std::scoped_lock lock{mutex_};
  port.keep(sample);
}

void Inbox::close() {
  const std::scoped_lock lock{mutex_};
  closed_ = true;
}

std::uint64_t Inbox::dropped() const {
  const std::scoped_lock lock{mutex_};
  return dropped_;
}

Inbox::Ahead Inbox::ahead() const {
  const std::scoped_lock lock{mutex_};
  return ahead_;
}

namespace detail {

std::size_t input_size(const InputPort& port) { return port.shown().size(); }
const SampleRef& input_sample(const InputPort& port, std::size_t index) {
  return port.shown()[index];
}
void input_heeds(InputPort& port, bool (*heeds)(const void* message)) { port.heed_only(heeds); }

bool input_fresh(const InputPort& port) { return port.fresh(); }

}  // namespace detail
}  // namespace armature
