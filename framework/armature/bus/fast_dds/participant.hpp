// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "armature/bus/fast_dds/discovery.hpp"
#include "armature/bus/fast_dds/shared_memory.hpp"
#include "armature/bus/network_interface.hpp"
#include "armature/values/expected.hpp"

namespace eprosima::fastdds::dds {
class DomainParticipant;
class Publisher;
class Subscriber;
class Topic;
}  // namespace eprosima::fastdds::dds

namespace armature ARMATURE_EXPORT {

class DdsLog;

struct ParticipantSettings {
  int domain = 0;
  std::vector<std::string> interfaces = {};  // as in TransportOptions
  std::string name;
  Discovery::Watcher watcher;
  std::function<void(const std::string&)> on_note;  // any thread; must only enqueue
  SharedMemory shared_memory;                       // looked at before Fast DDS uses it
  bool uses_shared_memory = true;
};

/// The one DDS participant of the process: shared memory, UDP on the loopback interface and on
/// those of the settings, discovery, and the topics it has. Endpoints must be deleted before it.
class Participant {
 public:
  static Expected<std::unique_ptr<Participant>> make(ParticipantSettings settings);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  eprosima::fastdds::dds::Publisher& publisher() { return *publisher_; }
  eprosima::fastdds::dds::Subscriber& subscriber() { return *subscriber_; }
  /// The topic of that name and type, made when it is asked for the first time. Refused when the
  /// name is in use with another type.
  Expected<eprosima::fastdds::dds::Topic*> topic(const std::string& name, const std::string& type);
  const GuidPrefix& guid_prefix() const { return guid_prefix_; }
  Discovery& discovery() { return discovery_; }

 private:
  class Listener;
  Participant(ParticipantSettings& settings, std::vector<NetworkInterface> joined);
  Expected<void> open(const ParticipantSettings& settings);
  /// Whether the way to that address of another machine leads over a joined interface.
  bool reaches(const std::string& address) const;

  const std::vector<NetworkInterface> joined_;  // beside loopback
  Discovery discovery_;
  std::unique_ptr<DdsLog> log_;
  std::unique_ptr<Listener> listener_;
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
  GuidPrefix guid_prefix_{};
  std::mutex topics_mutex_;
  std::map<std::string, eprosima::fastdds::dds::Topic*> topics_;
};

}  // namespace armature
