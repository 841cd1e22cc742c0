// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/participant.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <fastdds/dds/core/policy/ParameterTypes.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <thread>
#include <utility>

#include "armature/bus/fast_dds/cdr_payload.hpp"
#include "armature/bus/fast_dds/dds_log.hpp"
#include "armature/bus/fast_dds/guid_of.hpp"
#include "armature/bus/topic_name.hpp"

namespace armature {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastdds::rtps::SharedMemTransportDescriptor;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;
using eprosima::fastrtps::Duration_t;

constexpr int kGreatestDomain = 232;  // beyond it, RTPS port numbers pass 65535
/// How many participants of a peer are asked without multicast; Fast DDS asks 4 when not told.
constexpr std::uint32_t kParticipantsOfAPeer = 20;
constexpr std::chrono::milliseconds kServerAnswersWithin{3000};

rtps::GuidPrefix_t server_prefix() {
  rtps::GuidPrefix_t prefix;
  rtps::get_server_client_default_guidPrefix(0, prefix);
  return prefix;
}

/// Threads that are started meanwhile leave the process' signals to the program's own threads.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

void use_transports(dds::DomainParticipantQos& qos, const ParticipantSettings& settings,
                    const Network& network) {
  qos.transport().use_builtin_transports = false;
  auto udp = std::make_shared<UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  for (const NetworkInterface& interface : network.joined) {
    std::ranges::copy(interface.addresses, std::back_inserter(udp->interfaceWhiteList));
  }
  udp->maxInitialPeersRange = kParticipantsOfAPeer;
  udp->receiveBufferSize = settings.receive_buffer;
  qos.transport().user_transports.push_back(udp);
  if (!settings.network.shared_memory) return;

  clean_shared_memory(settings.shared_memory.folder);
  if (const auto usable = check_shared_memory(settings.shared_memory, kSharedMemoryOfProcess);
      !usable) {
    settings.on_note("no shared memory, topics go over UDP: " + usable.error().text);
    return;
  }
  auto shared_memory = std::make_shared<SharedMemTransportDescriptor>();
  shared_memory->segment_size(kSharedMemorySegment);
  shared_memory->max_message_size(kGreatestMessageBytes);
  qos.transport().user_transports.push_back(shared_memory);
}

rtps::Locator_t udp_locator(const std::string& address, std::uint32_t port) {
  rtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(locator, address);
  locator.port = port;
  return locator;
}

/// Where announcements go beside the peers: where they go when there are none.
void announce_as_usual(rtps::LocatorList_t& destinations, std::uint32_t multicast_port) {
  destinations.push_back(udp_locator("239.255.0.1", multicast_port));
  rtps::Locator_t shared_memory;
  shared_memory.kind = LOCATOR_KIND_SHM;
  shared_memory.address[0] = 'M';
  shared_memory.port = multicast_port;
  destinations.push_back(shared_memory);
}

/// How others are found.
void use_discovery(rtps::BuiltinAttributes& builtin, const ParticipantSettings& settings,
                   const Network& network) {
  auto& discovery = builtin.discovery_config;
  if (network.server) {
    rtps::RemoteServerAttributes server;
    server.guidPrefix = server_prefix();
    server.metatrafficUnicastLocatorList.push_back(
        udp_locator(network.server->host, network.server->port));
    discovery.m_DiscoveryServers.push_back(server);
    discovery.discoveryProtocol = settings.sees_all ? rtps::DiscoveryProtocol_t::SUPER_CLIENT
                                                    : rtps::DiscoveryProtocol_t::CLIENT;
  } else if (!network.peers.empty()) {
    const rtps::PortParameters ports;
    announce_as_usual(builtin.initialPeersList,
                      ports.getMulticastPort(static_cast<std::uint32_t>(settings.network.domain)));
    constexpr std::uint32_t kAllPorts = 0;
    for (const std::string& peer : network.peers) {
      builtin.initialPeersList.push_back(udp_locator(peer, kAllPorts));
    }
  }
}

dds::DomainParticipantQos participant_qos(const ParticipantSettings& settings,
                                          const Network& network) {
  dds::DomainParticipantQos qos;
  qos.name(settings.name);
  use_transports(qos, settings, network);
  auto& builtin = qos.wire_protocol().builtin;
  use_discovery(builtin, settings, network);
  builtin.discovery_config.leaseDuration = Duration_t{1, 0};  // a killed process is gone after this
  builtin.discovery_config.leaseDuration_announcementperiod = Duration_t{0.25L};
  builtin.discovery_config.initial_announcements.count = 10;
  builtin.discovery_config.initial_announcements.period = Duration_t{0.05L};
  builtin.use_WriterLivelinessProtocol = true;
  builtin.typelookup_config.use_client = false;
  builtin.typelookup_config.use_server = false;
  return qos;
}

/// What a stranger says may stand in a message: one line, and not a long one.
std::string printable(std::string text) {
  constexpr std::size_t kLongest = 200;
  if (text.size() > kLongest) text.resize(kLongest);
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20 || c >= 0x7F; }, '?');
  return text;
}

/// Fast DDS and Cyclone DDS tell host and process under names of their own. Cyclone's participants
/// have no name, but their program has.
ParticipantIdentity identity_of(const rtps::ParticipantProxyData& participant) {
  const auto told = [&](const std::vector<std::string_view>& names) -> std::string {
    for (const auto& property : participant.m_properties) {
      if (std::ranges::find(names, property.first()) != names.end()) return property.second();
    }
    return {};
  };
  std::string name = participant.m_participantName.to_string();
  if (name.empty()) name = told({"__ProcessName"});
  std::string host = told({dds::parameter_policy_physical_data_host, "__Hostname"});
  host.resize(std::min(host.find(':'), host.size()));  // Fast DDS adds a number to it
  return {.name = printable(name),
          .host = printable(host),
          .pid = printable(told({dds::parameter_policy_physical_data_process, "__Pid"}))};
}

/// True when the participant says that it is of this host, and there is no such process here. One
/// with another host name, or with a process id of another container that is in use here, too, is
/// not taken for gone.
bool is_gone(const ParticipantIdentity& identity) {
  std::array<char, 256> own_host{};
  gethostname(own_host.data(), own_host.size() - 1);
  if (identity.host != own_host.data()) return false;
  pid_t pid = 0;
  const char* const end = identity.pid.data() + identity.pid.size();
  const auto read = std::from_chars(identity.pid.data(), end, pid);
  if (read.ec != std::errc{} || read.ptr != end || pid <= 0) return false;
  return kill(pid, 0) != 0 && errno == ESRCH;
}

/// The addresses of a participant that is on another machine; none of one of this machine.
/// Multicast brings such announcements as soon as any program of this machine has joined the group
/// on another interface.
std::vector<std::string> addresses_elsewhere(const rtps::ParticipantProxyData& participant) {
  std::vector<std::string> elsewhere;
  for (const auto* locators : {&participant.metatraffic_locators, &participant.default_locators}) {
    for (const rtps::Locator_t& locator : locators->unicast) {
      if (locator.kind == LOCATOR_KIND_SHM) return {};
      if (locator.kind != LOCATOR_KIND_UDPv4) continue;
      elsewhere.push_back(rtps::IPLocator::toIPv4string(locator));
      if (is_own_address(elsewhere.back())) return {};
    }
  }
  return elsewhere;
}

}  // namespace

/// Feeds the discovery.
class Participant::Listener final : public dds::DomainParticipantListener {
 public:
  Listener(Participant& participant, std::function<void(const std::string&)> on_note)
      : participant_{participant}, on_note_{std::move(on_note)} {}

  void on_participant_discovery(dds::DomainParticipant*,
                                rtps::ParticipantDiscoveryInfo&& found) override {
    using Info = rtps::ParticipantDiscoveryInfo;
    const GuidPrefix prefix = prefix_of(found.info.m_guid.guidPrefix);
    if (found.status == Info::DISCOVERED_PARTICIPANT) {
      discovery().participant_found(prefix, identity_of(found.info));
      ignore_if_elsewhere(prefix, found.info);
      report_unreachable_memory(prefix, found.info);
    } else if (found.status != Info::CHANGED_QOS_PARTICIPANT) {
      discovery().participant_gone(prefix, found.status == Info::DROPPED_PARTICIPANT);
    }
  }

  void on_publisher_discovery(dds::DomainParticipant*, rtps::WriterDiscoveryInfo&& found) override {
    using Info = rtps::WriterDiscoveryInfo;
    if (found.status == Info::REMOVED_WRITER)
      return discovery().endpoint_gone(guid_of(found.info.guid()));
    note(found.info, true);
  }

  void on_subscriber_discovery(dds::DomainParticipant*,
                               rtps::ReaderDiscoveryInfo&& found) override {
    using Info = rtps::ReaderDiscoveryInfo;
    if (found.status == Info::REMOVED_READER)
      return discovery().endpoint_gone(guid_of(found.info.guid()));
    note(found.info, false);
  }

 private:
  Discovery& discovery() { return participant_.discovery_; }

  /// Host, process and a random number are the first eight bytes.
  bool is_of_this_process(const GuidPrefix& other) const {
    return std::equal(other.begin(), other.begin() + 8, participant_.guid_prefix_.begin());
  }

  void ignore_if_elsewhere(const GuidPrefix& prefix, const rtps::ParticipantProxyData& found) {
    const std::vector<std::string> addresses = addresses_elsewhere(found);
    const bool heard = addresses.empty() || std::ranges::any_of(addresses, [&](const auto& one) {
                         return participant_.reaches(one);
                       });
    if (heard || !discovery().ignore(prefix)) return;
    const auto& joined = participant_.network_.joined;
    on_note_(discovery().who(prefix) + " is ignored: it is not on this machine (it answers at " +
             addresses.back() + "), and " +
             (joined.empty() ? "only the loopback interface is joined"
                             : "no joined interface leads there: " + to_text(joined)));
  }

  /// Fast DDS sends to whoever has shared memory on this machine through that alone, whether it
  /// arrives there or not. A process that was halted hears late of others, and of those that have
  /// ended meanwhile there is nothing to tell.
  void report_unreachable_memory(const GuidPrefix& prefix,
                                 const rtps::ParticipantProxyData& found) {
    if (!participant_.uses_shared_memory_ || is_of_this_process(prefix)) return;
    for (const rtps::Locator_t& locator : found.default_locators.unicast) {
      if (locator.kind != LOCATOR_KIND_SHM) continue;
      const auto reached = check_shared_memory_port(participant_.memory_folder_, locator.port);
      if (reached || is_gone(identity_of(found))) continue;
      on_note_(discovery().who(prefix) +
               " is on this machine and gets nothing from here through shared memory (" +
               reached.error().text +
               "): it is in another container, or another user's. Let one of the two use none: "
               "`dds: {shared_memory: off}`, or --no-shared-memory");
    }
  }

  template <class ProxyData>
  void note(const ProxyData& data, bool writes) {
    Endpoint endpoint;
    endpoint.guid = guid_of(data.guid());
    if (endpoint.guid.participant == participant_.guid_prefix_) return;
    endpoint.writes = writes;
    endpoint.topic = data.topicName().to_string();
    endpoint.type = printable(data.typeName().to_string());
    endpoint.reliable = data.m_qos.m_reliability.kind == dds::RELIABLE_RELIABILITY_QOS;
    endpoint.transient_local = data.m_qos.m_durability.kind != dds::VOLATILE_DURABILITY_QOS;
    endpoint.tag = parse_endpoint_tag(data.m_qos.m_userData.data_vec());
    endpoint.tag.deployment = printable(endpoint.tag.deployment);
    endpoint.tag.fingerprint = printable(endpoint.tag.fingerprint);
    discovery().endpoint_found(std::move(endpoint));
  }

  Participant& participant_;
  std::function<void(const std::string&)> on_note_;
};

Expected<std::unique_ptr<Participant>> Participant::make(ParticipantSettings settings) {
  const int domain = settings.network.domain;
  if (domain < 0 || domain > kGreatestDomain) {
    return refuse("DDS domain " + std::to_string(domain) + " is not within 0 and " +
                  std::to_string(kGreatestDomain));
  }
  auto network = find_network(settings.network);
  if (!network) return tl::unexpected{network.error()};
  if (!settings.on_note) settings.on_note = [](const std::string&) {};
  std::unique_ptr<Participant> made{new Participant{settings, std::move(*network)}};
  if (const auto opened = made->open(settings); !opened) return tl::unexpected{opened.error()};
  if (const auto met = made->meet_server(); !met) return tl::unexpected{met.error()};
  return made;
}

Participant::Participant(ParticipantSettings& settings, Network network)
    : network_{std::move(network)},
      memory_folder_{settings.shared_memory.folder},
      uses_shared_memory_{settings.network.shared_memory},
      discovery_{std::move(settings.watcher)},
      log_{std::make_unique<DdsLog>(settings.on_note)},
      listener_{std::make_unique<Listener>(*this, settings.on_note)} {}

Expected<void> Participant::open(const ParticipantSettings& settings) {
  const SignalsBlocked signals_blocked;
  const auto refused = [&](const std::string& what) {
    return refuse("DDS: no " + what + " in domain " + std::to_string(settings.network.domain) +
                  "; is the loopback interface up, and are UDP ports free?");
  };
  auto* factory = dds::DomainParticipantFactory::get_instance();
  // Enabled by hand: its own GUID must be known before the first endpoint is discovered.
  dds::DomainParticipantFactoryQos factory_qos;
  factory->get_qos(factory_qos);
  factory_qos.entity_factory().autoenable_created_entities = false;
  factory->set_qos(factory_qos);
  participant_ = factory->create_participant(static_cast<dds::DomainId_t>(settings.network.domain),
                                             participant_qos(settings, network_), listener_.get(),
                                             dds::StatusMask::none());
  factory_qos.entity_factory().autoenable_created_entities = true;
  factory->set_qos(factory_qos);
  if (!participant_) return refused("participant");
  make_shared_memory_private(settings.shared_memory.folder);
  guid_prefix_ = prefix_of(participant_->guid().guidPrefix);
  if (participant_->enable() != ReturnCode_t::RETCODE_OK) return refused("participant");
  make_shared_memory_private(settings.shared_memory.folder);
  publisher_ = participant_->create_publisher(dds::PublisherQos{});
  subscriber_ = participant_->create_subscriber(dds::SubscriberQos{});
  if (!publisher_ || !subscriber_) return refused("publisher and subscriber");
  return {};
}

Expected<void> Participant::meet_server() const {
  if (!network_.server) return {};
  const GuidPrefix server = prefix_of(server_prefix());
  const auto deadline = std::chrono::steady_clock::now() + kServerAnswersWithin;
  while (!discovery_.knows(server)) {
    if (std::chrono::steady_clock::now() > deadline) {
      const std::string port = std::to_string(network_.server->port);
      return refuse("no discovery server answers at " + network_.server->host + ":" + port +
                    "; start it there: fastdds discovery -i 0 -l " + network_.server->host +
                    " -p " + port);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  return {};
}

bool Participant::reaches(const std::string& address) const {
  if (network_.joined.empty()) return false;
  const auto interface = interface_towards(address);
  return interface && std::ranges::find(network_.joined, *interface, &NetworkInterface::name) !=
                          network_.joined.end();
}

Participant::~Participant() {
  if (participant_) {
    participant_->set_listener(nullptr);
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
}

Expected<dds::Topic*> Participant::topic(const std::string& name, const std::string& type) {
  const std::scoped_lock lock{topics_mutex_};
  if (const auto found = topics_.find(name); found != topics_.end()) {
    if (found->second->get_type_name() == type) return found->second;
    return refuse("topic '" + ros_topic_name(name) + "' is used with the type " +
                  found->second->get_type_name() + " and with " + type + " in this process");
  }
  if (participant_->find_type(type).empty()) {
    participant_->register_type(make_cdr_type(type));
  }
  dds::Topic* made = participant_->create_topic(name, type, dds::TopicQos{});
  if (!made) return refuse("DDS: cannot create the topic '" + ros_topic_name(name) + "'");
  topics_[name] = made;
  return made;
}

void Participant::drop_topic(const std::string& name) {
  const std::scoped_lock lock{topics_mutex_};
  const auto found = topics_.find(name);
  if (found == topics_.end()) return;
  if (participant_->delete_topic(found->second) == ReturnCode_t::RETCODE_OK) topics_.erase(found);
}

}  // namespace armature
