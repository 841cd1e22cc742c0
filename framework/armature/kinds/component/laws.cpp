// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/component/laws.hpp"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <functional>
#include <random>

#include "armature/kinds/component/random_message.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/messages/message_type.hpp"

namespace armature {
namespace {

/// A component that is activated as its period says, or every 10 ms when it waits for messages
/// only.
class Driven {
 public:
  explicit Driven(const ComponentSubject& subject)
      : bench_{subject.make()},
        period_s_{bench_->period() ? to_seconds(*bench_->period()) : 0.01} {}

  void step() {
    now_s_ += period_s_;
    bench_->step(now_s_);
  }
  ComponentHarness& bench() { return *bench_; }
  double now_s() const { return now_s_; }
  double period_s() const { return period_s_; }

 private:
  std::unique_ptr<ComponentHarness> bench_;
  double period_s_;
  double now_s_ = 0;
};

/// Writes `now_s` where a message with a header has its stamp: behind the encapsulation header.
void put_stamp(double now_s, std::vector<std::byte>& cdr) {
  constexpr std::size_t kStamp = 4;
  const auto sec = static_cast<std::int32_t>(now_s);
  const auto nanosec = static_cast<std::uint32_t>(1e9 * (now_s - sec));
  std::memcpy(&cdr.at(kStamp), &sec, sizeof sec);
  std::memcpy(&cdr.at(kStamp + sizeof sec), &nanosec, sizeof nanosec);
}

std::vector<std::byte> empty_message(const MessageType& type) {
  const std::unique_ptr<void, void (*)(void*)> message{type.create(), type.destroy};
  std::vector<std::byte> cdr;
  type.encode(message.get(), cdr);
  return cdr;
}

using MakeMessage = std::function<std::vector<std::byte>(const MessageType&)>;

/// Gives every input a message that bears the instant of its arrival, then activates it.
void round_of_messages(Driven& driven, const MakeMessage& make, LawCheck& check) {
  const double arrival_s = driven.now_s() + driven.period_s();
  for (const PortBinding& input : driven.bench().inputs()) {
    const MessageType& type = *find_message_type(input.spec.type);
    std::vector<std::byte> cdr = make(type);
    if (type.stamp) put_stamp(arrival_s, cdr);
    check.that(driven.bench().send_encoded(input.spec.name, cdr), "a message made here decodes");
  }
  driven.step();
}

void claims_ports(const ComponentSubject& subject, LawCheck&) { subject.make(); }

void silence(const ComponentSubject& subject, LawCheck& check) {
  Driven driven{subject};
  for (int i = 0; i < subject.rounds; ++i) {
    check.asks(fmt::format("activation {}, nothing has arrived", i + 1));
    driven.step();
  }
}

void empty_messages(const ComponentSubject& subject, LawCheck& check) {
  Driven driven{subject};
  for (int i = 0; i < 10; ++i) {
    check.asks(fmt::format("activation {}, an empty message at every input", i + 1));
    round_of_messages(driven, empty_message, check);
  }
}

void messages_with(RandomNumbers numbers, const ComponentSubject& subject, LawCheck& check) {
  Driven driven{subject};
  std::mt19937_64 random{subject.seed};
  for (int i = 0; i < subject.rounds; ++i) {
    check.asks(fmt::format("seed {}, activation {}", subject.seed, i + 1));
    round_of_messages(
        driven,
        [&](const MessageType& type) {
          return random_message(*describe_type(type.ros_name), numbers, random);
        },
        check);
  }
}

void nan_messages(const ComponentSubject& subject, LawCheck& check) {
  messages_with(RandomNumbers::none, subject, check);
}

void random_messages(const ComponentSubject& subject, LawCheck& check) {
  messages_with(RandomNumbers::finite, subject, check);
  messages_with(RandomNumbers::any, subject, check);
}

void stop_is_answered(const ComponentSubject& subject, LawCheck& check) {
  constexpr double kStopWithin_s = 3;  // `run: {stop_within_s}` unless a deployment says otherwise
  Driven driven{subject};
  for (int i = 0; i < 10; ++i) driven.step();
  driven.bench().begin_stop(driven.now_s());
  const double end_s = driven.now_s() + kStopWithin_s;
  while (!driven.bench().stopped() && driven.now_s() < end_s) driven.step();
  check.asks("a stop request after ten activations without a message");
  check.that(driven.bench().stopped(), "it is at rest 3 s after it was asked to stop");
}

void made_again(const ComponentSubject& subject, LawCheck& check) {
  for (int i = 0; i < 10; ++i) {
    check.asks(fmt::format("made for the {}. time", i + 1));
    Driven driven{subject};
    driven.step();
  }
}

}  // namespace

#define ARMATURE_LAW_ENTRY(Name, function, says) Law<ComponentSubject>{#Name, says, &function},
std::span<const Law<ComponentSubject>> component_laws() {
  static constexpr std::array kLaws{ARMATURE_COMPONENT_LAWS(ARMATURE_LAW_ENTRY)};
  return kLaws;
}

}  // namespace armature
