// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/qos.hpp"

#include <array>
#include <utility>

namespace armature {
namespace {

constexpr std::array<std::pair<QosProfile, std::string_view>, 6> kNames{{
    {QosProfile::sensor, "sensor"},
    {QosProfile::state, "state"},
    {QosProfile::command, "command"},
    {QosProfile::reply, "reply"},
    {QosProfile::latched, "latched"},
    {QosProfile::log, "log"},
}};

}  // namespace

std::optional<QosProfile> find_qos_profile(std::string_view name) {
  for (const auto& [profile, text] : kNames) {
    if (text == name) return profile;
  }
  return std::nullopt;
}

std::string_view to_string(QosProfile profile) {
  return kNames[static_cast<std::size_t>(profile)].second;
}

QosSettings settings(QosProfile profile) {
  switch (profile) {
    case QosProfile::sensor:
      // A picture is many datagrams, which arrive all at once: a small receive buffer loses some of
      // them every time, and the picture is whole only when they are sent again before the next.
      return {.reader_reliable = false,
              .depth = 2,
              .heartbeat = seconds(0.02),
              .repair_delay = seconds(0.0005)};
    case QosProfile::state: return {.depth = 10};
    case QosProfile::command:
      return {.depth = 10,
              .lifespan = seconds(0.5),
              .liveliness_lease = seconds(0.5),
              .heartbeat = seconds(0.02)};
    case QosProfile::reply: return {.transient_local = true, .depth = 10, .lifespan = seconds(5)};
    case QosProfile::latched: return {.transient_local = true, .depth = 1};
    case QosProfile::log: return {.transient_local = true, .depth = 100};
  }
  return {};
}

QosSettings reader_settings(QosProfile profile, bool same_deployment_only) {
  QosSettings made = settings(profile);
  made.reader_reliable = made.reader_reliable || same_deployment_only;
  return made;
}

}  // namespace armature
