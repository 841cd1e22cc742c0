// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// The named QoS profiles; every field is stated, nothing is left to a middleware's default.
///   sensor   volatile, the newest two; reliable towards the deployment's own writers, best effort
///            towards others'
///   state    reliable, volatile, a short history
///   command  reliable, volatile, short history, samples expire: yesterday's goal is never executed
///   reply    reliable, transient local, samples expire: whoever asked gets the answer also when
///   the
///            answering end discovers its reader a moment after its question
///   latched  reliable, transient local, newest only: late joiners get the last sample
///   log      reliable, transient local, the newest hundred: late joiners get what was just said
enum class QosProfile { sensor, state, command, reply, latched, log };

std::optional<QosProfile> find_qos_profile(std::string_view name);
std::string_view to_string(QosProfile profile);

struct QosSettings {
  bool writer_reliable = true;
  bool reader_reliable = true;  // of writers that are not the deployment's own
  bool transient_local = false;
  int depth = 1;  // KEEP_LAST
  /// Samples that are older when they arrive are dropped; 0: none. By the deployment's clock
  /// between its own processes, which a step of the system clock does not change. DDS itself only
  /// judges, by the system clock, what it keeps for those who come later.
  Duration lifespan = Duration{0};
  /// After which a writer that says nothing counts as dead; none: when its participant does, after
  /// a second. With one, Fast DDS sets a timer of another thread with each sample.
  std::optional<Duration> liveliness_lease = {};
  /// How often a reliable writer tells its readers what they should have, while one has not said
  /// that it has: how long a lost last sample stays lost. Fast DDS waits 3 s when not told.
  Duration heartbeat = seconds(0.2);
  /// How long a reader waits before it tells what it misses, and a writer before it sends that
  /// again. Fast DDS waits so long when not told.
  Duration repair_delay = seconds(0.005);
};
QosSettings settings(QosProfile profile);
/// Those of a reader; `same_deployment_only`: of the deployment's own writers, all of which are
/// reliable.
QosSettings reader_settings(QosProfile profile, bool same_deployment_only);

}  // namespace armature
