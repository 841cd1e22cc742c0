// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/endpoint_qos.hpp"

#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

namespace armature {
namespace {

using namespace eprosima::fastdds::dds;  // NOLINT: names of one API, in one file
using eprosima::fastrtps::c_TimeInfinite;
using eprosima::fastrtps::Duration_t;

Duration_t dds_duration(Duration duration) {
  return Duration_t{static_cast<long double>(to_seconds(duration))};
}

/// What writers and readers have in common.
template <class Qos>
void state_common(Qos& qos, const QosSettings& settings, bool reliable,
                  const std::string& user_data) {
  qos.reliability().kind = reliable ? RELIABLE_RELIABILITY_QOS : BEST_EFFORT_RELIABILITY_QOS;
  qos.reliability().max_blocking_time = Duration_t{0.1L};
  qos.durability().kind =
      settings.transient_local ? TRANSIENT_LOCAL_DURABILITY_QOS : VOLATILE_DURABILITY_QOS;
  qos.history().kind = KEEP_LAST_HISTORY_QOS;
  qos.history().depth = settings.depth;
  // Room for samples that are still being assembled or acknowledged beside the history itself.
  qos.resource_limits().max_samples = 2 * settings.depth + 8;
  qos.resource_limits().max_instances = 1;
  qos.resource_limits().max_samples_per_instance = 2 * settings.depth + 8;
  qos.resource_limits().allocated_samples = settings.depth;
  qos.resource_limits().extra_samples = 1;
  // Readers of Fast DDS go by their own lifespan, so both ends state it. It is judged by the system
  // clock, at whose step all commands would end for good: those the reader judges itself.
  const bool kept = settings.transient_local && settings.lifespan > Duration{0};
  qos.lifespan().duration = kept ? dds_duration(settings.lifespan) : c_TimeInfinite;
  qos.deadline().period = c_TimeInfinite;
  qos.latency_budget().duration = Duration_t{0, 0};
  qos.ownership().kind = SHARED_OWNERSHIP_QOS;
  qos.destination_order().kind = BY_RECEPTION_TIMESTAMP_DESTINATIONORDER_QOS;
  qos.data_sharing().off();
  qos.endpoint().history_memory_policy =
      eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  qos.user_data().data_vec({user_data.begin(), user_data.end()});
}

}  // namespace

DataWriterQos writer_qos(const QosSettings& settings, const std::string& user_data) {
  DataWriterQos qos;
  state_common(qos, settings, settings.writer_reliable, user_data);
  qos.liveliness().kind = AUTOMATIC_LIVELINESS_QOS;
  if (const auto lease = settings.liveliness_lease) {
    qos.liveliness().lease_duration = dds_duration(*lease);
    // Often enough that a cable which loses every third packet does not make a writer look dead.
    qos.liveliness().announcement_period = dds_duration(*lease / 10);
  }
  qos.publish_mode().kind = SYNCHRONOUS_PUBLISH_MODE;  // the egress thread may wait, others never
  qos.reliable_writer_qos().times.heartbeatPeriod = dds_duration(settings.heartbeat);
  qos.reliable_writer_qos().times.nackResponseDelay = dds_duration(settings.repair_delay);
  qos.representation().m_value = {XCDR_DATA_REPRESENTATION};
  return qos;
}

DataReaderQos reader_qos(const QosSettings& settings, std::optional<Duration> liveliness_lease,
                         const std::string& user_data) {
  DataReaderQos qos;
  state_common(qos, settings, settings.reader_reliable, user_data);
  qos.liveliness().kind = AUTOMATIC_LIVELINESS_QOS;
  qos.liveliness().lease_duration =
      liveliness_lease ? dds_duration(*liveliness_lease) : c_TimeInfinite;
  qos.time_based_filter().minimum_separation = Duration_t{0, 0};
  qos.reader_data_lifecycle().autopurge_disposed_samples_delay = c_TimeInfinite;
  qos.reader_data_lifecycle().autopurge_no_writer_samples_delay = c_TimeInfinite;
  qos.reliable_reader_qos().times.heartbeatResponseDelay = dds_duration(settings.repair_delay);
  qos.expects_inline_qos(false);
  qos.type_consistency().representation.m_value = {XCDR_DATA_REPRESENTATION};
  return qos;
}

}  // namespace armature
