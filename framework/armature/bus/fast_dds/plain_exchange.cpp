// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/plain_exchange.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>

#include <atomic>
#include <chrono>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <optional>
#include <string>

#include "armature/bus/fast_dds/endpoint_qos.hpp"
#include "armature/bus/fast_dds/receive_buffer.hpp"
#include "armature/bus/fast_dds/shared_memory.hpp"
#include "armature/messages/cdr_size.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/values/wake_up.hpp"

namespace armature {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace cdr = eprosima::fastcdr;
using Clock = std::chrono::steady_clock;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;
using Picture = msg::Image;

/// What fastddsgen writes for a type.
class PictureType final : public dds::TopicDataType {
 public:
  PictureType() {
    setName("plain_exchange::Picture");
    m_typeSize = 512;
    m_isGetKeyDefined = false;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }
  bool serialize(void* data, SerializedPayload_t* payload) override {
    cdr::FastBuffer buffer{reinterpret_cast<char*>(payload->data), payload->max_size};
    cdr::Cdr encoder{buffer, cdr::Cdr::LITTLE_ENDIANNESS, cdr::Cdr::DDS_CDR};
    payload->encapsulation = CDR_LE;
    encoder.serialize_encapsulation();
    static_cast<const Picture*>(data)->serialize(encoder);
    payload->length = static_cast<std::uint32_t>(encoder.getSerializedDataLength());
    return true;
  }
  bool deserialize(SerializedPayload_t* payload, void* data) override {
    cdr::FastBuffer buffer{reinterpret_cast<char*>(payload->data), payload->length};
    cdr::Cdr decoder{buffer, cdr::Cdr::DEFAULT_ENDIAN, cdr::Cdr::DDS_CDR};
    decoder.read_encapsulation();
    static_cast<Picture*>(data)->deserialize(decoder);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] {
      CdrSize size;
      static_cast<const Picture*>(data)->serialize(size);
      constexpr std::size_t kHeader = 4;
      return static_cast<std::uint32_t>(kHeader + size.bytes());
    };
  }
  void* createData() override { return new Picture; }
  void deleteData(void* data) override { delete static_cast<Picture*>(data); }
  bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

dds::DomainParticipantQos participant_qos() {
  namespace rtps = eprosima::fastdds::rtps;
  dds::DomainParticipantQos qos;
  qos.name("plain exchange");
  qos.transport().use_builtin_transports = false;
  auto udp = std::make_shared<rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  udp->receiveBufferSize = kReceiveBuffer;
  auto shared_memory = std::make_shared<rtps::SharedMemTransportDescriptor>();
  shared_memory->segment_size(kSharedMemorySegment);
  shared_memory->max_message_size(kGreatestMessageBytes);
  qos.transport().user_transports = {udp, shared_memory};
  return qos;
}

/// One end of a question and its answer.
class Channel final : public dds::DataReaderListener {
 public:
  Channel(QosProfile qos, bool answers) : qos_{qos}, answers_{answers} {}

  bool open(dds::DomainParticipant& participant, dds::Publisher& publisher,
            dds::Subscriber& subscriber, const std::string& type) {
    const std::string name = "plain_exchange_" + std::string{to_string(qos_)};
    dds::Topic* question = participant.create_topic(name + "_question", type, dds::TopicQos{});
    dds::Topic* answer = participant.create_topic(name + "_answer", type, dds::TopicQos{});
    if (!question || !answer) return false;
    writer_ =
        publisher.create_datawriter(answers_ ? answer : question, writer_qos(settings(qos_), ""));
    reader_ = subscriber.create_datareader(
        answers_ ? question : answer, reader_qos(reader_settings(qos_, true), std::nullopt, ""),
        this);
    return writer_ && reader_;
  }

  bool met() const {
    dds::PublicationMatchedStatus readers;
    dds::SubscriptionMatchedStatus writers;
    writer_->get_publication_matched_status(readers);
    reader_->get_subscription_matched_status(writers);
    return readers.current_count > 0 && writers.current_count > 0;
  }

  std::vector<double> round_trips(std::size_t bytes, int count) {
    constexpr std::chrono::seconds kTimeout{1};
    std::vector<double> times;
    sent_.data_().resize(bytes);
    while (count-- > 0) {
      sent_.step_(++number_);
      const Clock::time_point asked = Clock::now();
      writer_->write(&sent_);
      do {
        if (!answered_.wait_until(asked + kTimeout)) return times;
      } while (answer_ != number_);
      times.push_back(std::chrono::duration<double>(arrived_.load() - asked).count());
    }
    return times;
  }

  void on_data_available(dds::DataReader* reader) override {
    const Clock::time_point now = Clock::now();
    dds::SampleInfo info;
    while (reader->take_next_sample(&received_, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      if (answers_) {
        sent_.step_(received_.step_());
        sent_.data_().resize(received_.data_().size());
        writer_->write(&sent_);
      } else {
        arrived_ = now;
        answer_ = received_.step_();
        answered_.notify();
      }
    }
  }

 private:
  const QosProfile qos_;
  const bool answers_;
  dds::DataWriter* writer_ = nullptr;
  dds::DataReader* reader_ = nullptr;
  Picture sent_, received_;
  std::uint32_t number_ = 0;
  std::atomic<std::uint32_t> answer_{0};
  std::atomic<Clock::time_point> arrived_{};
  WakeUp answered_;
};

class FastDdsExchange final : public PlainExchange {
 public:
  explicit FastDdsExchange(bool answers)
      : small_{QosProfile::state, answers}, large_{QosProfile::sensor, answers} {}
  ~FastDdsExchange() override {
    if (!participant_) return;
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  bool open(int domain) {
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
        static_cast<std::uint32_t>(domain), participant_qos());
    if (!participant_) return false;
    const dds::TypeSupport type{new PictureType};
    participant_->register_type(type);
    dds::Publisher* publisher = participant_->create_publisher(dds::PublisherQos{});
    dds::Subscriber* subscriber = participant_->create_subscriber(dds::SubscriberQos{});
    return publisher && subscriber &&
           small_.open(*participant_, *publisher, *subscriber, type.get_type_name()) &&
           large_.open(*participant_, *publisher, *subscriber, type.get_type_name());
  }

  bool met() const override { return small_.met() && large_.met(); }
  std::vector<double> round_trips(QosProfile qos, std::size_t bytes, int count) override {
    return (qos == QosProfile::sensor ? large_ : small_).round_trips(bytes, count);
  }

 private:
  dds::DomainParticipant* participant_ = nullptr;
  Channel small_, large_;
};

}  // namespace

Expected<std::unique_ptr<PlainExchange>> PlainExchange::make(const PlainExchangeOptions& options) {
  auto exchange = std::make_unique<FastDdsExchange>(options.answers);
  if (!exchange->open(options.domain)) {
    return refuse("DDS: cannot make a participant of its own in domain " +
                  std::to_string(options.domain));
  }
  return exchange;
}

}  // namespace armature
