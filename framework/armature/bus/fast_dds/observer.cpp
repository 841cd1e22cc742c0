// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/observer.hpp"

#include <algorithm>
#include <chrono>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "armature/bus/fast_dds/cdr_payload.hpp"
#include "armature/bus/fast_dds/endpoint_qos.hpp"
#include "armature/bus/fast_dds/guid_of.hpp"
#include "armature/bus/fast_dds/participant.hpp"
#include "armature/bus/fast_dds/sequence_gaps.hpp"
#include "armature/bus/topic_name.hpp"
#include "armature/values/recent.hpp"

namespace armature {
namespace {

namespace dds = eprosima::fastdds::dds;

/// The order in which the endpoints of a topic are told: first the writer that is read, the one of
/// the deployment that has the topic, then those of other deployments of ours, and other writers.
int place(const Endpoint& endpoint) {
  if (!endpoint.writes) return 3;
  if (!endpoint.tag.ours) return 2;
  return endpoint.topic.starts_with("rt/" + endpoint.tag.deployment + "/") ? 0 : 1;
}

ObservedEndpoint observed(const Endpoint& endpoint, const Discovery& discovery) {
  ObservedEndpoint seen{.writes = endpoint.writes,
                        .owner = discovery.owner(endpoint),
                        .type = endpoint.type,
                        .reliable = endpoint.reliable,
                        .transient_local = endpoint.transient_local};
  if (endpoint.tag.ours) {
    seen.deployment = endpoint.tag.deployment;
    seen.layout = endpoint.tag.layout;
  }
  const auto entity = std::ranges::copy(endpoint.guid.participant, seen.guid.begin()).out;
  std::ranges::copy(endpoint.guid.entity, entity);
  return seen;
}

/// Whether a reader that is made for the writer `read_like` hears another one: it asks for no more
/// than that one offers.
bool hears(const Endpoint& read_like, const Endpoint& writer) {
  return writer.type == read_like.type && (writer.reliable || !read_like.reliable) &&
         (writer.transient_local || !read_like.transient_local);
}

using OnSample = std::function<void(const ObservedSample&)>;

class Watch final : public dds::DataReaderListener {
 public:
  /// `read_like`: the writer that the reader is made for.
  Watch(std::string asked, Endpoint read_like, const Discovery& discovery, OnSample on_sample)
      : asked_{std::move(asked)},
        read_like_{std::move(read_like)},
        discovery_{discovery},
        on_sample_{std::move(on_sample)} {}

  /// The name that was asked for, and that of DDS.
  const std::string& asked() const { return asked_; }
  const std::string& topic() const { return read_like_.topic; }
  const Endpoint& read_like() const { return read_like_; }
  const OnSample& on_sample() const { return on_sample_; }

  void on_data_available(dds::DataReader* from) override {
    const std::scoped_lock lock{mutex_};
    dds::SampleInfo info;
    Incoming& taken = cdr_;
    while (from->take_next_sample(&taken, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      const Guid writer = guid_of(info.sample_identity.writer_guid());
      const std::uint64_t lost =
          gaps_.lost_before(writer, info.sample_identity.sequence_number().to64long());
      on_sample_({cdr_.bytes, Time{info.source_timestamp.to_ns()}, read_like_.type, lost,
                  writer_with(writer)});
    }
  }

  dds::DataReader* reader = nullptr;

 private:
  const ObservedEndpoint* writer_with(const Guid& guid) {
    if (const ObservedEndpoint* known = writers_.find(guid)) return known;
    const auto found = discovery_.find(guid);
    return found ? &writers_.put(guid, observed(*found, discovery_)) : nullptr;
  }

  const std::string asked_;
  const Endpoint read_like_;
  const Discovery& discovery_;
  const OnSample on_sample_;
  std::mutex mutex_;
  IncomingBytes cdr_;
  SequenceGaps gaps_;
  Recent<Guid, ObservedEndpoint> writers_;
};

class Observer final : public DdsObserver {
 public:
  Observer(std::unique_ptr<Participant> participant, bool asks_again)
      : participant_{std::move(participant)}, asks_again_{asks_again} {}

  ~Observer() override {
    for (const auto& watch : watches_) end(*watch);
  }

  std::vector<ObservedTopic> topics() const override {
    std::map<std::string, ObservedTopic> by_name;
    const auto add_once = [](std::vector<std::string>& texts, const std::string& text) {
      if (std::ranges::find(texts, text) == texts.end()) texts.push_back(text);
    };
    const Discovery& discovery = participant_->discovery();
    std::map<std::string, Endpoint> read_like;  // by topic
    for (const auto& watch : watches_) read_like.emplace(watch->topic(), watch->read_like());
    auto endpoints = named_endpoints();
    std::ranges::stable_sort(endpoints, {}, place);
    for (const Endpoint& endpoint : endpoints) {
      ObservedTopic& topic = by_name[endpoint.topic];
      topic.name = endpoint.topic;
      add_once(topic.types, endpoint.type);
      if (endpoint.tag.ours) add_once(topic.deployments, endpoint.tag.deployment);
      ++(endpoint.writes ? topic.writers : topic.readers);
      const Endpoint& first =
          read_like.try_emplace(endpoint.topic, asked_of(endpoint)).first->second;
      topic.endpoints.push_back(observed(endpoint, discovery));
      topic.endpoints.back().is_heard = hears(first, endpoint);
    }
    std::vector<ObservedTopic> sorted;
    for (auto& [name, topic] : by_name) sorted.push_back(std::move(topic));
    return sorted;
  }

  Expected<void> watch(const std::string& topic, Duration timeout, OnSample on_sample) override {
    auto writer = wait_for_writer(topic, timeout);
    if (!writer) {
      return refuse("nobody writes '" + ros_topic_name(dds_topic_name(topic)) + "'");
    }
    return watch(topic, std::move(*writer), std::move(on_sample));
  }

  void unwatch(const std::string& topic) override {
    std::erase_if(watches_, [&](const auto& watch) {
      const bool is_it = watch->asked() == topic;
      if (is_it) end(*watch);
      return is_it;
    });
  }

  std::vector<std::string> watch_again() override {
    const auto endpoints = named_endpoints();
    const auto hears_any = [&](const auto& watch) {
      const auto first = first_writer(endpoints, watch->topic());
      const auto is_heard = [&](const Endpoint& endpoint) {
        return endpoint.topic == watch->topic() && place(endpoint) == place(*first) &&
               hears(watch->read_like(), endpoint);
      };
      return !first || std::ranges::any_of(endpoints, is_heard);
    };
    const auto first_deaf = std::stable_partition(watches_.begin(), watches_.end(), hears_any);
    const std::vector<std::unique_ptr<Watch>> deaf{std::move_iterator{first_deaf},
                                                   std::move_iterator{watches_.end()}};
    watches_.erase(first_deaf, watches_.end());
    for (const auto& watch : deaf) end(*watch);
    std::vector<std::string> again;
    for (const auto& ended : deaf) {
      auto writer = first_writer(endpoints, ended->topic());
      if (watch(ended->asked(), std::move(*writer), ended->on_sample())) {
        again.push_back(ended->topic());
      }
    }
    return again;
  }

 private:
  /// Those of topics that have a name of their own here: "/a" is the name of "rt/a" for ROS 2, and
  /// the DDS topic "/a" would pass for that.
  std::vector<Endpoint> named_endpoints() const {
    auto endpoints = participant_->discovery().endpoints();
    std::erase_if(endpoints, [](const Endpoint& one) { return one.topic.starts_with('/'); });
    return endpoints;
  }

  /// The reader for a writer asks for as much as that one offers and no more, so that it always
  /// matches.
  Endpoint asked_of(Endpoint writer) const {
    writer.reliable = writer.reliable && asks_again_;
    return writer;
  }

  Expected<void> watch(const std::string& asked, Endpoint writer, OnSample on_sample) {
    const auto dds_topic = participant_->topic(writer.topic, writer.type);
    if (!dds_topic) return tl::unexpected{dds_topic.error()};
    writer = asked_of(std::move(writer));
    // Samples that it keeps for late joiners come all at once.
    const QosSettings settings{.reader_reliable = writer.reliable,
                               .transient_local = writer.transient_local,
                               .depth = writer.transient_local ? 100 : 10};
    auto watch = std::make_unique<Watch>(asked, std::move(writer), participant_->discovery(),
                                         std::move(on_sample));
    watch->reader = participant_->subscriber().create_datareader(
        *dds_topic, reader_qos(settings, std::nullopt, ""), watch.get());
    if (!watch->reader) {
      return refuse("DDS: cannot create a reader on '" + ros_topic_name(watch->topic()) + "'");
    }
    watches_.push_back(std::move(watch));
    return {};
  }

  void end(const Watch& watch) {
    watch.reader->set_listener(nullptr);
    participant_->subscriber().delete_datareader(watch.reader);
    participant_->drop_topic(watch.topic());  // its next writer may have another type
  }

  static std::optional<Endpoint> first_writer(const std::vector<Endpoint>& endpoints,
                                              const std::string& topic) {
    std::optional<Endpoint> first;
    for (const Endpoint& endpoint : endpoints) {
      if (endpoint.topic != topic || !endpoint.writes) continue;
      if (!first || place(endpoint) < place(*first)) first = endpoint;
    }
    return first;
  }

  std::optional<Endpoint> wait_for_writer(const std::string& asked, Duration timeout) const {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    do {
      const auto endpoints = named_endpoints();
      for (const std::string& topic : {asked, dds_topic_name(asked)}) {
        if (auto first = first_writer(endpoints, topic)) return first;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds{10});
    } while (std::chrono::steady_clock::now() < deadline);
    return std::nullopt;
  }

  std::unique_ptr<Participant> participant_;
  const bool asks_again_;
  std::vector<std::unique_ptr<Watch>> watches_;
};

}  // namespace

Expected<std::unique_ptr<DdsObserver>> DdsObserver::make(const ObserverOptions& options) {
  NetworkOptions network = options.network;
  // One that is killed must leave no lock behind for which those that it watched wait. With other
  // interfaces joined Fast DDS does not tell its loopback address, and programs that know no other
  // meet it in shared memory only.
  network.shared_memory = network.shared_memory && !network.interfaces.empty();
  auto participant = Participant::make(
      {.network = std::move(network), .name = "armature observer", .sees_all = true});
  if (!participant) return tl::unexpected{participant.error()};
  return std::make_unique<Observer>(std::move(*participant), options.asks_again);
}

}  // namespace armature
