// SPDX-License-Identifier: Apache-2.0
// An external monitor of a running deployment, with Fast DDS: what each process consists of, and
// twice a second how its components are.
//   monitor_fast_dds DEPLOYMENT [DOMAIN]
// It joins all interfaces, as Fast DDS does by itself. Ctrl-C ends it.
#include <armature/messages/armature_msgs.hpp>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <span>
#include <string>
#include <thread>

namespace fast_dds = eprosima::fastdds::dds;
namespace msg = armature::msg;

std::atomic<bool> g_ended{false};

/// A message type of Armature as Fast DDS wants it. Only for reading.
template <class Message>
class ReadType final : public fast_dds::TopicDataType {
 public:
  ReadType() {
    setName(std::string{type_.dds_name}.c_str());
    m_typeSize = 512;  // at first; it grows to what is sent
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* message) override {
    return type_.decode(std::as_bytes(std::span{payload->data, payload->length}), message);
  }
  void* createData() override { return type_.create(); }
  void deleteData(void* message) override { type_.destroy(message); }
  bool serialize(void*, eprosima::fastrtps::rtps::SerializedPayload_t*) override { return false; }
  std::function<std::uint32_t()> getSerializedSizeProvider(void*) override { return {}; }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }

 private:
  const armature::MessageType& type_ = armature::message_type<Message>();
};

/// Reads "<deployment>/<name>". ROS and Armature put "rt/" before every topic's name. One who comes
/// late gets what is kept for him when he asks for it (transient local), as the writer offers it.
template <class Message>
class Reader {
 public:
  Reader(fast_dds::DomainParticipant& participant, const std::string& topic, bool latched) {
    const fast_dds::TypeSupport type{new ReadType<Message>};
    type.register_type(&participant);
    fast_dds::DataReaderQos qos;
    qos.reliability().kind = fast_dds::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind =
        latched ? fast_dds::TRANSIENT_LOCAL_DURABILITY_QOS : fast_dds::VOLATILE_DURABILITY_QOS;
    qos.history().depth = 100;  // every process writes one
    qos.endpoint().history_memory_policy =
        eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    auto* subscriber = participant.create_subscriber(fast_dds::SUBSCRIBER_QOS_DEFAULT);
    reader_ = subscriber->create_datareader(
        participant.create_topic("rt/" + topic, type.get_type_name(), fast_dds::TOPIC_QOS_DEFAULT),
        qos);
  }
  /// Hands all samples that have come to `show`.
  template <class Show>
  void take(const Show& show) {
    Message message;
    fast_dds::SampleInfo info;
    while (reader_->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
      if (info.valid_data) show(message);
    }
  }

 private:
  fast_dds::DataReader* reader_ = nullptr;
};

void show_description(const msg::DeploymentDescription& told) {
  std::printf("%s: process %s of Armature %s, fingerprint %.12s\n", told.deployment_().c_str(),
              told.process_().c_str(), told.version_().c_str(), told.fingerprint_().c_str());
  for (const auto& component : told.components_()) {
    std::printf("  %s (%s)\n", component.name_().c_str(), component.plugin_().c_str());
    for (const auto& port : component.ports_()) {
      std::printf("    %s %s [%s]\n", port.output_() ? "->" : "<-", port.topic_().c_str(),
                  port.type_().c_str());
    }
  }
}

void show_states(const msg::ComponentStates& told) {
  constexpr std::array kStates{"ok", "degraded", "fault", "stalled"};
  for (const auto& state : told.components_()) {
    std::printf("%s/%s: %s", told.process_().c_str(), state.component_().c_str(),
                state.state_() < kStates.size() ? kStates[state.state_()] : "?");
    if (!state.reason_().empty()) std::printf(" (%s)", state.reason_().c_str());
    std::printf(", 99 of 100 steps within %.0f us, %llu samples dropped\n",
                1e6 * state.step_().p99_(), static_cast<unsigned long long>(state.dropped_()));
  }
}

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: monitor_fast_dds DEPLOYMENT [DOMAIN]\n");
    return 2;
  }
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { g_ended = true; });
  const std::string deployment = argv[1];
  auto* factory = fast_dds::DomainParticipantFactory::get_instance();
  auto* participant =
      factory->create_participant(argc > 2 ? static_cast<std::uint32_t>(std::atoi(argv[2])) : 0,
                                  fast_dds::PARTICIPANT_QOS_DEFAULT);
  if (!participant) {
    std::fprintf(stderr, "monitor_fast_dds: cannot join DDS\n");
    return 1;
  }
  Reader<msg::DeploymentDescription> descriptions{*participant, deployment + "/description", true};
  Reader<msg::ComponentStates> states{*participant, deployment + "/component_states", false};
  while (!g_ended) {
    descriptions.take(show_description);
    states.take(show_states);
    std::fflush(stdout);
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
  }
  participant->delete_contained_entities();
  factory->delete_participant(participant);
  return 0;
}
