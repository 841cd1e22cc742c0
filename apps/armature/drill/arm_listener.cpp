// SPDX-License-Identifier: Apache-2.0
#include "drill/arm_listener.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>
#include <utility>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"

namespace armature::drill {

ArmListener::ArmListener(PluginRegistry& plugins, const DrilledDeployment& deployment, int domain)
    : deployment_{deployment} {
  for (const DrilledArm& arm : deployment.arms) heard_.emplace_back(ArmRecord{arm.limits});
  auto observer = plugins.make<DdsObserver>(
      "observer/fast_dds", ObserverOptions{.network = {.domain = domain}, .asks_again = false});
  if (!observer) throw PluginError("a drill cannot listen: " + observer.error().text);
  observer_ = std::move(*observer);
}

bool ArmListener::find_arms(const std::function<bool()>& goes_on) {
  for (std::size_t i = 0; i < heard_.size(); ++i) {
    Heard& heard = heard_[i];
    const auto on_sample = [&heard](const ObservedSample& sample) { add(heard, sample); };
    while (!observer_->watch(deployment_.arms[i].measured_topic, seconds(0.1), on_sample)) {
      if (!goes_on()) return false;
    }
    find_hand(deployment_.arms[i]);
  }
  return true;
}

void ArmListener::find_hand(const DrilledArm& arm) {
  if (arm.hand_topic.empty()) return;
  Heard& hand = hands_.emplace_back(ArmRecord{arm.limits});
  const auto found = observer_->watch(arm.hand_topic, seconds(5),
                                      [&hand](const ObservedSample& sample) { add(hand, sample); });
  if (!found) throw PluginError("a drill cannot hear a hand: " + found.error().text);
}

void ArmListener::add(Heard& heard, const ObservedSample& sample) {
  const Arrival arrival = Arrival::clock::now();
  msg::JointState message;
  if (!message_type<msg::JointState>().decode(sample.cdr, &message)) return;
  const std::scoped_lock lock{heard.mutex};
  heard.record.add({.stamp = stamp_of(message.header_().stamp_()),
                    .arrival = arrival,
                    .q = message.position_(),
                    .v = message.velocity_()});
}

bool ArmListener::any_moves() const { return std::ranges::any_of(moving(), std::identity{}); }

std::vector<bool> ArmListener::moving() const {
  return ask([](const ArmRecord& record) { return moves(record.speed_now()); });
}

std::vector<bool> ArmListener::went_on_after(Arrival from) const {
  return ask([&](const ArmRecord& record) { return record.goes_on_after(from); });
}

std::vector<bool> ArmListener::ask(const std::function<bool(const ArmRecord&)>& question) const {
  std::vector<bool> answers;
  for (const Heard& heard : heard_) {
    const std::scoped_lock lock{heard.mutex};
    answers.push_back(question(heard.record));
  }
  return answers;
}

std::optional<Arrival> ArmListener::hand_moved_after(Arrival from) const {
  // The arm's own samples may come a little before the hand's that it follows.
  constexpr Duration kOvertakes = seconds(0.02);
  std::optional<Arrival> first;
  for (const Heard& hand : hands_) {
    const std::scoped_lock lock{hand.mutex};
    const auto moved = hand.record.moves_after(from);
    if (!moved) continue;
    const Arrival begun = std::max(from, moved->arrival - kOvertakes);
    first = std::min(first.value_or(begun), begun);
  }
  return first;
}

void ArmListener::wait_for_rest() const {
  constexpr std::chrono::milliseconds kRests{300}, kLook{5};
  const auto now = [] { return Arrival::clock::now(); };
  const auto end = now() + std::chrono::seconds{5};
  for (auto moved = now(); now() - moved < kRests && now() < end;) {
    if (any_moves()) moved = now();
    std::this_thread::sleep_for(kLook);
  }
}

void ArmListener::hear_out() const {
  constexpr std::chrono::milliseconds kSilence{100}, kLook{5};
  const auto now = [] { return Arrival::clock::now(); };
  const auto count = [this] {
    std::size_t samples = 0;
    for (const Heard& heard : heard_) {
      const std::scoped_lock lock{heard.mutex};
      samples += heard.record.samples().size();
    }
    return samples;
  };
  std::size_t heard = count();
  for (auto silent_since = now(); now() - silent_since < kSilence;) {
    std::this_thread::sleep_for(kLook);
    if (const std::size_t all = count(); std::exchange(heard, all) != all) silent_since = now();
  }
}

std::vector<ArmRecord> ArmListener::records() const {
  std::vector<ArmRecord> records;
  for (const Heard& heard : heard_) {
    const std::scoped_lock lock{heard.mutex};
    records.push_back(heard.record);
  }
  return records;
}

}  // namespace armature::drill
