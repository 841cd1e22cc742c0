// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "armature/bus/qos.hpp"

namespace eprosima::fastdds::dds {
class DataReaderQos;
class DataWriterQos;
}  // namespace eprosima::fastdds::dds

namespace armature ARMATURE_EXPORT {

/// Every QoS field stated; Fast DDS's defaults are not those of ROS 2.
eprosima::fastdds::dds::DataWriterQos writer_qos(const QosSettings& settings,
                                                 const std::string& user_data);

/// `liveliness_lease`: after which a silent writer counts as dead; only writers that promise it
/// match (ours do, those of ROS 2 do not). Without it, the participant's lease decides.
eprosima::fastdds::dds::DataReaderQos reader_qos(const QosSettings& settings,
                                                 std::optional<Duration> liveliness_lease,
                                                 const std::string& user_data);

}  // namespace armature
