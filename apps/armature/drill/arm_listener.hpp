// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "armature/bus/fast_dds/observer.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
#include "drill/arm_record.hpp"
#include "drill/drilled_deployment.hpp"

namespace armature::drill {

/// Hears the samples of all arms of a deployment from outside of its processes.
class ArmListener {
 public:
  /// Throws PluginError when the domain cannot be joined. `deployment` outlives this.
  ArmListener(PluginRegistry& plugins, const DrilledDeployment& deployment, int domain);

  /// Waits until every arm has begun to tell where it is, as long as `goes_on()`; false when it
  /// ended before.
  bool find_arms(const std::function<bool()>& goes_on);
  /// Whether an arm moves, by its newest sample.
  bool any_moves() const;
  /// Which arms do, in the order of the deployment's arms.
  std::vector<bool> moving() const;
  /// Which arms have moved by a sample that arrived later than `from`.
  std::vector<bool> went_on_after(Arrival from) const;
  /// When a hand of the deployment's that moves an arm first moved after `from`; nothing: it has
  /// not.
  std::optional<Arrival> hand_moved_after(Arrival from) const;
  /// Until no arm has moved for 0.3 s; arms that do not come to rest are waited for for 5 s.
  void wait_for_rest() const;
  /// Until the last samples of a run that has ended have arrived: none has for 0.1 s.
  void hear_out() const;
  /// The samples that were heard so far, arm by arm in the order of the deployment's arms.
  std::vector<ArmRecord> records() const;

 private:
  struct Heard {
    ArmRecord record;
    mutable std::mutex mutex{};
  };
  void find_hand(const DrilledArm& arm);
  static void add(Heard& heard, const ObservedSample& sample);
  std::vector<bool> ask(const std::function<bool(const ArmRecord&)>& question) const;

  const DrilledDeployment& deployment_;
  std::deque<Heard> heard_, hands_;
  PluginPtr<DdsObserver> observer_;  // goes first: it calls what adds to those
};

}  // namespace armature::drill
