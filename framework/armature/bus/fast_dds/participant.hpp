// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "armature/bus/fast_dds/discovery.hpp"
#include "armature/bus/fast_dds/receive_buffer.hpp"
#include "armature/bus/fast_dds/shared_memory.hpp"
#include "armature/bus/network.hpp"
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
  NetworkOptions network = {};
  std::string name;
  Discovery::Watcher watcher;
  std::function<void(const std::string&)> on_note;  // any thread; must only enqueue
  SharedMemory shared_memory = {};                  // looked at before Fast DDS uses it
  std::uint32_t receive_buffer = kReceiveBuffer;    // [B] of a UDP socket, if the system gives it
  /// A discovery server tells it all that there is, not only who shares its topics.
  bool sees_all = false;
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
  /// Frees the name for another type, unless a reader or a writer uses the topic still.
  void drop_topic(const std::string& name);
  const GuidPrefix& guid_prefix() const { return guid_prefix_; }
  Discovery& discovery() { return discovery_; }

 private:
  class Listener;
  Participant(ParticipantSettings& settings, Network network);
  Expected<void> open(const ParticipantSettings& settings);
  /// Waits for the discovery server, if there is one to be.
  Expected<void> meet_server() const;
  /// Whether the way to that address of another machine leads over a joined interface.
  bool reaches(const std::string& address) const;

  const Network network_;
  const std::filesystem::path memory_folder_;
  const bool uses_shared_memory_;
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
