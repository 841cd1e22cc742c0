// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>

#include "armature/bus/sample.hpp"
#include "armature/messages/message_type.hpp"

namespace armature ARMATURE_EXPORT {

class InputPort;   // runtime/component/inbox.hpp: mailbox and reading rule
class OutputPort;  // runtime/component/output_port.hpp: topic and clock

namespace detail {
std::size_t input_size(const InputPort& port);
const SampleRef& input_sample(const InputPort& port, std::size_t index);
bool input_fresh(const InputPort& port);
void input_heeds(InputPort& port, bool (*heeds)(const void* message));
SampleRef output_loan(OutputPort& port);
void output_prepare(OutputPort& port, const void* message);
void output_publish(OutputPort& port, SampleRef sample);
bool output_wanted(const OutputPort& port);
}  // namespace detail

/// A component's typed input. What it shows is frozen for one activation: nothing changes while
/// `step` runs. How it reads (latest or queue, trigger, join by stamp, greatest age) is declared in
/// plugin.yaml. Real-time safe.
template <class Message>
class Input {
 public:
  Input() = default;
  explicit Input(const InputPort& port) : port_{&port} {}

  /// `latest`: the newest sample, kept until a newer one comes (nullptr: none yet, or older than
  /// max_age_s). `queue`: the newest of this activation's samples.
  const Message* latest() const {
    const std::size_t n = detail::input_size(*port_);
    return n == 0 ? nullptr : &get(n - 1);
  }
  /// True when this activation brought a sample that no activation before has seen.
  bool fresh() const { return detail::input_fresh(*port_); }

  /// `queue`: everything since the last activation, oldest first. `latest`: at most one.
  std::size_t size() const { return detail::input_size(*port_); }
  const Message& operator[](std::size_t i) const { return get(i); }
  const SampleInfo& info(std::size_t i) const { return detail::input_sample(*port_, i).info(); }
  /// The sample itself: held, its message stays as it is after this activation too.
  SampleRef sample(std::size_t i) const { return detail::input_sample(*port_, i); }

 private:
  const Message& get(std::size_t i) const {
    return *static_cast<const Message*>(detail::input_sample(*port_, i).message());
  }
  const InputPort* port_ = nullptr;
};

/// A sample on loan from the bus: fill it, then publish it. Dropping it publishes nothing.
template <class Message>
class Loan {
 public:
  Loan(OutputPort& port, SampleRef sample) : port_{&port}, sample_{std::move(sample)} {}
  Message& operator*() { return *static_cast<Message*>(sample_.mutable_message()); }
  Message* operator->() { return static_cast<Message*>(sample_.mutable_message()); }
  void publish() { detail::output_publish(*port_, std::move(sample_)); }

 private:
  OutputPort* port_;
  SampleRef sample_;
};

/// A component's typed output.
template <class Message>
class Output {
 public:
  Output() = default;
  explicit Output(OutputPort& port) : port_{&port} {}

  /// False while nobody would get a sample: what is only for onlookers need not be computed then.
  /// Always true where late joiners get samples (profiles reply and latched). Real-time safe.
  bool has_subscribers() const { return detail::output_wanted(*port_); }
  /// A sample with the content of an earlier one (so that its sequences keep their memory): write
  /// every field. Real-time safe in the steady state.
  Loan<Message> loan() { return {*port_, detail::output_loan(*port_)}; }
  /// Copies `message` into every sample that is kept ready, so that its sequences and texts have
  /// their memory before the first step. While the component is constructed; not real-time safe.
  void prepare(const Message& message) { detail::output_prepare(*port_, &message); }
  /// Copies `message` into a loan and publishes it.
  void publish(const Message& message) {
    auto loaned = loan();
    *loaned = message;
    loaned.publish();
  }

 private:
  OutputPort* port_ = nullptr;
};

}  // namespace armature
