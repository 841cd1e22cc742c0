// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <utility>

#include "armature/bus/fast_dds/cdr_payload.hpp"
#include "armature/bus/fast_dds/endpoint_qos.hpp"
#include "armature/bus/fast_dds/fast_dds_link.hpp"
#include "armature/bus/fast_dds/guid_of.hpp"
#include "armature/bus/fast_dds/met_peers.hpp"
#include "armature/bus/topic_name.hpp"

namespace armature {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

class FastDdsWriter final : public RemoteWriter, private dds::DataWriterListener {
 public:
  FastDdsWriter(std::shared_ptr<FastDdsLink> link, const TopicSpec& topic)
      : link_{std::move(link)}, topic_{topic}, settings_{settings(topic.qos)} {}

  Expected<void> open() {
    Participant& participant = *link_->participant;
    const auto topic = participant.topic(topic_.name, std::string{topic_.type->dds_name});
    if (!topic) return tl::unexpected{topic.error()};
    writer_ = participant.publisher().create_datawriter(
        *topic, writer_qos(settings_, to_user_data(link_->tag_for(*topic_.type))), this);
    if (!writer_)
      return refuse("DDS: cannot create a writer on '" + ros_topic_name(topic_.name) + "'");
    queue_ = link_->egress_for(topic_.qos)
                 .open(static_cast<std::size_t>(settings_.depth),
                       [this](const SampleRef& sample) { send(sample); });
    link_->conflicts.own_endpoint_added({.writes = true, .topic = topic_}, participant.discovery());
    return {};
  }

  ~FastDdsWriter() override {
    if (!writer_) return;
    queue_.reset();
    writer_->set_listener(nullptr);
    link_->participant->publisher().delete_datawriter(writer_);
  }

  void offer(const SampleRef& sample) override {
    // DDS keeps such a sample for those who come later.
    if (matched_readers() > 0 || settings_.transient_local) queue_->offer(sample);
  }
  int matched_readers() const override { return watchers_.load(std::memory_order_relaxed); }
  int peers() const override { return peers_.count(); }
  std::uint64_t dropped() const override { return queue_->dropped(); }
  std::vector<Watcher> who_watches() const override {
    const Discovery& discovery = link_->participant->discovery();
    std::vector<Watcher> watchers;
    for (const Endpoint& endpoint : discovery.endpoints()) {
      if (endpoint.writes || endpoint.topic != topic_.name) continue;
      watchers.push_back({.owner = discovery.owner(endpoint), .of_deployment = endpoint.tag.ours});
    }
    return watchers;
  }
  bool acknowledged(Duration timeout) override {
    constexpr Duration kLongest = seconds(2e9);  // DDS counts seconds in 32 bits
    return queue_->drained(timeout) &&
           writer_->wait_for_acknowledgments(eprosima::fastrtps::Duration_t{
               static_cast<long double>(to_seconds(std::min(timeout, kLongest)))}) ==
               ReturnCode_t::RETCODE_OK;
  }

 private:
  /// What DDS keeps for a time it must stamp itself: it judges the time by the system clock.
  bool keeps_lifespan() const {
    return settings_.transient_local && settings_.lifespan > Duration{0};
  }

  void send(const SampleRef& sample) {
    OutgoingMessage outgoing{.type = topic_.type, .message = sample.message()};
    rtps::WriteParams params;
    if (link_->shared_clock && !keeps_lifespan()) {
      rtps::Time_t stamp;
      stamp.from_ns(sample.info().published.ns);
      params.source_timestamp(stamp);
    }
    if (const std::uint64_t number = sample.info().sequence; number > 0) {
      // DDS numbers what it sends; readers in the deployment are told how the writer numbers it.
      params.related_sample_identity().writer_guid(writer_->guid());
      params.related_sample_identity().sequence_number(rtps::SequenceNumber_t{number});
    }
    if (!writer_->write(&outgoing, params)) {
      link_->conflicts.report(
          {TransportEvent::Kind::note, topic_.name,
           "DDS did not take a sample of '" + ros_topic_name(topic_.name) + "'"});
    }
  }

  void on_publication_matched(dds::DataWriter*,
                              const dds::PublicationMatchedStatus& status) override {
    // The process' own readers match too and get their samples by pointer.
    const Guid reader = guid_of(rtps::iHandle2GUID(status.last_subscription_handle));
    if (reader.participant == link_->participant->guid_prefix()) return;
    watchers_.fetch_add(status.current_count_change, std::memory_order_relaxed);
    if (status.current_count_change < 0) {
      peers_.gone(reader);
    } else if (link_->is_peer(reader)) {
      peers_.met(reader);
    }
  }

  void on_offered_incompatible_qos(dds::DataWriter*,
                                   const dds::OfferedIncompatibleQosStatus& status) override {
    link_->conflicts.report(
        {TransportEvent::Kind::qos_conflict, topic_.name,
         "a reader on '" + ros_topic_name(topic_.name) +
             "' asks for more than our writer's profile '" + std::string{to_string(topic_.qos)} +
             "' offers: " + qos_policy_name(static_cast<std::uint32_t>(status.last_policy_id)) +
             " (readers there: " + owners_on(topic_.name, false, link_->participant->discovery()) +
             ")"});
  }

  std::shared_ptr<FastDdsLink> link_;
  TopicSpec topic_;
  QosSettings settings_;
  dds::DataWriter* writer_ = nullptr;
  std::atomic<int> watchers_{0};
  MetPeers peers_;
  std::unique_ptr<Egress::Queue> queue_;
};

}  // namespace

Expected<std::unique_ptr<RemoteWriter>> make_fast_dds_writer(std::shared_ptr<FastDdsLink> link,
                                                             const TopicSpec& topic) {
  auto writer = std::make_unique<FastDdsWriter>(std::move(link), topic);
  if (const auto opened = writer->open(); !opened) return tl::unexpected{opened.error()};
  return writer;
}

}  // namespace armature
