// SPDX-License-Identifier: Apache-2.0
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <utility>

#include "armature/bus/fast_dds/cdr_payload.hpp"
#include "armature/bus/fast_dds/endpoint_qos.hpp"
#include "armature/bus/fast_dds/fast_dds_link.hpp"
#include "armature/bus/fast_dds/guid_of.hpp"
#include "armature/bus/fast_dds/met_peers.hpp"
#include "armature/bus/fast_dds/refusal_counts.hpp"
#include "armature/bus/fast_dds/sequence_gaps.hpp"
#include "armature/bus/topic_name.hpp"
#include "armature/values/recent.hpp"

namespace armature {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

class FastDdsReader final : public RemoteReader, private dds::DataReaderListener {
 public:
  FastDdsReader(std::shared_ptr<FastDdsLink> link, OwnEndpoint own,
                std::function<void(SampleRef)> deliver)
      : link_{std::move(link)}, own_{std::move(own)}, deliver_{std::move(deliver)} {}

  Expected<void> open() {
    Participant& participant = *link_->participant;
    const MessageType& type = *own_.topic.type;
    const QosSettings settings = reader_settings(own_.topic.qos, own_.same_deployment_only);
    const auto topic = participant.topic(own_.topic.name, std::string{type.dds_name});
    if (!topic) return tl::unexpected{topic.error()};
    auto pool = std::make_unique<SamplePool>(type, static_cast<std::size_t>(settings.depth) + 2,
                                             reuse_for(own_.topic.qos));
    pool_ = pool.get();
    {
      const std::scoped_lock lock{link_->pools_mutex};
      link_->pools.push_back(std::move(pool));
    }
    // Commands come from writers of ours, which promise to be heard every 0.5 s; elsewhere a writer
    // of ROS 2 promises nothing and must match all the same.
    std::optional<Duration> lease;
    if (own_.same_deployment_only) lease = settings.liveliness_lease;
    reader_ = participant.subscriber().create_datareader(
        *topic, reader_qos(settings, lease, to_user_data(link_->tag_for(type))), this);
    if (!reader_)
      return refuse("DDS: cannot create a reader on '" + ros_topic_name(own_.topic.name) + "'");
    link_->conflicts.own_endpoint_added(own_, participant.discovery());
    return {};
  }

  ~FastDdsReader() override {
    {
      const std::scoped_lock lock{mutex_};
      closed_ = true;
    }
    if (!reader_) return;
    reader_->set_listener(nullptr);
    link_->participant->subscriber().delete_datareader(reader_);
  }

  int writers() const override { return writers_.load(std::memory_order_relaxed); }
  int peers() const override { return peers_.count(); }
  std::vector<RefusedSamples> refused() const override {
    const std::scoped_lock lock{mutex_};
    return refused_.all();
  }

 private:
  void on_data_available(dds::DataReader* reader) override {
    const std::scoped_lock lock{mutex_};  // several receive threads, one order
    while (take_next(*reader)) {
    }
  }

  /// Takes a sample and delivers it, unless it is refused; false when there is none.
  bool take_next(dds::DataReader& reader) {
    dds::SampleInfo info;
    if (!next_) next_ = pool_->loan();
    IncomingMessage message{*own_.topic.type, next_.mutable_message()};
    Incoming& taken = message;
    if (reader.take_next_sample(&taken, &info) != ReturnCode_t::RETCODE_OK) return false;
    if (closed_ || !info.valid_data) return true;
    const Guid writer = guid_of(info.sample_identity.writer_guid());
    if (writer.participant == link_->participant->guid_prefix()) return true;
    if (const auto stranger = stranger_of(writer)) {
      refused_.add(*stranger);
      return true;
    }
    const std::uint64_t sequence = info.sample_identity.sequence_number().to64long();
    if (counts_lost()) lost_ += gaps_.lost_before(writer, sequence);
    const Time published = published_at(writer, Time{info.source_timestamp.to_ns()});
    if (is_expired(published)) return true;
    if (!message.decoded()) {
      report_undecodable(writer);
      return true;
    }
    next_.mutable_info() = {.published = published,
                            .sequence = number_of(info),
                            .lost_before = std::exchange(lost_, 0)};
    deliver_(std::move(next_));
    return true;
  }

  /// How its own process numbers the sample; 0: another program, which does not say.
  static std::uint64_t number_of(const dds::SampleInfo& info) {
    const auto& told = info.related_sample_identity;
    const bool is_of_writer = told.writer_guid() == info.sample_identity.writer_guid();
    return is_of_writer ? told.sequence_number().to64long() : 0;
  }

  /// Of what changes seldom the newest is wanted, and no more.
  bool counts_lost() const { return own_.topic.qos != QosProfile::latched; }

  /// Whose samples of that writer are refused; nothing when they are taken. A writer that is not
  /// discovered (yet) is nobody's.
  std::optional<std::string> stranger_of(const Guid& writer) {
    if (const auto* known = strangers_.find(writer)) return *known;
    const Discovery& discovery = link_->participant->discovery();
    const auto endpoint = discovery.find(writer);
    if (discovery.is_ignored(writer.participant)) return discovery.who(writer.participant);
    if (!endpoint) {
      return own_.same_deployment_only ? std::optional<std::string>{"an unknown writer"}
                                       : std::nullopt;
    }
    std::optional<std::string> stranger;
    if (link_->conflicts.refuses(*endpoint, own_)) stranger = discovery.owner(*endpoint);
    return strangers_.put(writer, stranger);
  }

  /// Only the deployment's own processes share our clock. Whoever else writes is judged by when his
  /// samples arrive.
  Time published_at(const Guid& writer, Time stamp) {
    const QosSettings settings = armature::settings(own_.topic.qos);
    const bool stamped_by_dds = settings.transient_local && settings.lifespan > Duration{0};
    if (!link_->shared_clock || stamped_by_dds || !is_peer(writer)) return link_->now();
    return stamp;
  }

  bool is_peer(const Guid& writer) {
    if (const bool* known = peer_writers_.find(writer)) return *known;
    if (!link_->participant->discovery().find(writer)) return false;
    return peer_writers_.put(writer, link_->is_peer(writer));
  }

  bool is_expired(Time published) const {
    const Duration lifespan = armature::settings(own_.topic.qos).lifespan;
    return lifespan > Duration{0} && link_->now() - published > lifespan;
  }

  void report_undecodable(const Guid& writer) {
    const auto endpoint = link_->participant->discovery().find(writer);
    link_->conflicts.report(
        {TransportEvent::Kind::layout_conflict, own_.topic.name,
         "a sample on '" + ros_topic_name(own_.topic.name) + "' from " +
             (endpoint ? link_->participant->discovery().owner(*endpoint) : "an unknown writer") +
             " is no " + std::string{own_.topic.type->dds_name} +
             ": its layout differs, or it is damaged"});
  }

  void on_subscription_matched(dds::DataReader*,
                               const dds::SubscriptionMatchedStatus& status) override {
    const Guid writer = guid_of(rtps::iHandle2GUID(status.last_publication_handle));
    if (writer.participant == link_->participant->guid_prefix()) return;
    writers_.fetch_add(status.current_count_change, std::memory_order_relaxed);
    if (status.current_count_change < 0) {
      peers_.gone(writer);
    } else if (link_->is_peer(writer)) {
      peers_.met(writer);
    }
  }

  void on_liveliness_changed(dds::DataReader*,
                             const dds::LivelinessChangedStatus& status) override {
    if (status.not_alive_count_change <= 0) return;
    const auto endpoint = link_->participant->discovery().find(
        guid_of(rtps::iHandle2GUID(status.last_publication_handle)));
    link_->conflicts.report_always(
        {TransportEvent::Kind::peer_lost, own_.topic.name,
         "the writer on '" + ros_topic_name(own_.topic.name) + "'" +
             (endpoint ? " of " + link_->participant->discovery().owner(*endpoint) : "") +
             " fell silent: its process died or hangs",
         endpoint && same_deployment(endpoint->tag, link_->tag)});
  }

  void on_requested_incompatible_qos(dds::DataReader*,
                                     const dds::RequestedIncompatibleQosStatus& status) override {
    link_->conflicts.report(
        {TransportEvent::Kind::qos_conflict, own_.topic.name,
         "a writer on '" + ros_topic_name(own_.topic.name) +
             "' offers less than our reader's profile '" + std::string{to_string(own_.topic.qos)} +
             "' asks for: " + qos_policy_name(static_cast<std::uint32_t>(status.last_policy_id)) +
             " (writers there: " +
             owners_on(own_.topic.name, true, link_->participant->discovery()) + ")"});
  }

  std::shared_ptr<FastDdsLink> link_;
  OwnEndpoint own_;
  std::function<void(SampleRef)> deliver_;
  SamplePool* pool_ = nullptr;
  dds::DataReader* reader_ = nullptr;
  std::atomic<int> writers_{0};
  MetPeers peers_;
  mutable std::mutex mutex_;  // guards what follows
  bool closed_ = false;
  SampleRef next_;  // what the next sample is decoded into
  SequenceGaps gaps_;
  std::uint64_t lost_ = 0;                              // since the sample that was delivered last
  Recent<Guid, std::optional<std::string>> strangers_;  // nothing: a writer that is heard
  Recent<Guid, bool> peer_writers_;
  RefusalCounts refused_;
};

}  // namespace

Expected<std::unique_ptr<RemoteReader>> make_fast_dds_reader(
    std::shared_ptr<FastDdsLink> link, const TopicSpec& topic, bool same_deployment_only,
    std::function<void(SampleRef)> deliver) {
  auto reader = std::make_unique<FastDdsReader>(
      std::move(link),
      OwnEndpoint{.writes = false, .topic = topic, .same_deployment_only = same_deployment_only},
      std::move(deliver));
  if (const auto opened = reader->open(); !opened) return tl::unexpected{opened.error()};
  return reader;
}

}  // namespace armature
