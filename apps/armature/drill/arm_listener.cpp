// SPDX-License-Identifier: Apache-2.0
#include "drill/arm_listener.hpp"

#include <algorithm>
#include <utility>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"

namespace armature::drill {
namespace {

/// Faster than what an arm does that holds.
constexpr double kMoves = 5e-3;  // [rad/s] or [m/s]

}  // namespace

ArmListener::ArmListener(PluginRegistry& plugins, const DrilledDeployment& deployment, int domain)
    : deployment_{deployment} {
  for (const DrilledArm& arm : deployment.arms) heard_.emplace_back(ArmRecord{arm.limits});
  auto observer = plugins.make<DdsObserver>("observer/fast_dds", ObserverOptions{.domain = domain});
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
  }
  return true;
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

bool ArmListener::any_moves() const {
  return std::ranges::any_of(heard_, [](const Heard& heard) {
    const std::scoped_lock lock{heard.mutex};
    return heard.record.speed_now() > kMoves;
  });
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
