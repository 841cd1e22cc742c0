// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/mcap_queue.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "armature/messages/known_types.hpp"
#include "armature/messages/ros_definition.hpp"

namespace armature {
namespace {

constexpr std::chrono::seconds kLongestChunk{1};  // what is lost when the program dies

/// How many messages of a channel who comes late is given.
std::size_t depth_of(const McapChannel& channel) {
  const auto qos = channel.metadata.find("qos");
  if (qos == channel.metadata.end()) return 0;
  if (qos->second == "latched") return 1;
  return qos->second == "log" ? 100 : 0;
}

/// Of the channel with that number; they are numbered in their order.
template <class Item>
std::size_t depth_of(const std::vector<Item>& preamble, std::uint16_t number) {
  for (const Item& item : preamble) {
    const auto* channel = std::get_if<McapChannel>(&item);
    if (channel && number-- == 0) return depth_of(*channel);
  }
  return 0;
}

/// Keeps a message for the next file when it is one of the last of a latched channel.
template <class Item, class Message>
void remember(std::vector<Item>& preamble, Message message) {
  const std::size_t depth = depth_of(preamble, message.channel);
  if (depth == 0) return;
  const auto is_older = [&](const Item& item) {
    const auto* older = std::get_if<Message>(&item);
    return older && older->channel == message.channel;
  };
  if (static_cast<std::size_t>(std::ranges::count_if(preamble, is_older)) >= depth) {
    preamble.erase(std::ranges::find_if(preamble, is_older));
  }
  preamble.emplace_back(std::move(message));
}

}  // namespace

McapQueue::McapQueue(const std::filesystem::path& file, McapWriter::Options options,
                     WhenFull when_full)
    : options_{std::move(options)}, when_full_{when_full} {
  open(file);
  thread_ = std::thread{[this] { run(); }};
}

McapQueue::McapQueue(Around around, McapWriter::Options options)
    : options_{std::move(options)}, when_full_{WhenFull::drop}, around_{std::move(around)} {
  options_.keeps_older = true;
  thread_ = std::thread{[this] { run(); }};
}

McapQueue::~McapQueue() { end_thread(); }

void McapQueue::end_thread() {
  {
    const std::scoped_lock lock{mutex_};
    ends_ = true;
  }
  news_.notify_one();
  if (thread_.joinable()) thread_.join();
}

/// Schemas and channels are numbered as the writer numbers them, which gets them in this order.
std::uint16_t McapQueue::add_channel(const std::string& topic, const std::string& dds_type,
                                     std::map<std::string, std::string> metadata) {
  const TypeDescription* type = describe_type(dds_type);
  metadata.emplace("dds_type", dds_type);
  const std::scoped_lock lock{mutex_};
  const auto number = static_cast<std::uint16_t>(schemas_.size() + 1);
  const auto [schema, is_new] = schemas_.try_emplace(dds_type, number);
  if (is_new) {
    waiting_.emplace_back(type ? McapSchema{.name = ros2_name(*type),
                                            .encoding = "ros2msg",
                                            .data = ros_definition(*type)}
                               : McapSchema{.name = dds_type});
  }
  waiting_.emplace_back(McapChannel{.schema_id = schema->second,
                                    .topic = topic,
                                    .message_encoding = "cdr",
                                    .metadata = std::move(metadata)});
  return channels_++;
}

void McapQueue::write(std::uint16_t channel, std::uint32_t sequence, Time log_time,
                      Time publish_time, std::vector<std::byte> data) {
  put(Message{channel, sequence, log_time, publish_time, std::move(data)});
}

/// Of the room for what waits [byte]: what is no message takes none, and has always room.
std::size_t McapQueue::bytes_of(const Item& item) {
  const auto* message = std::get_if<Message>(&item);
  return message ? sizeof(Item) + message->data.size() : 0;
}

void McapQueue::put(Item item) {
  const std::size_t bytes = bytes_of(item);
  {
    std::unique_lock lock{mutex_};
    const auto has_space = [&] {
      return bytes == 0 || waiting_bytes_ + bytes <= kMaxWaiting || waiting_.empty() ||
             !problem_.empty();
    };
    if (when_full_ == WhenFull::wait) space_.wait(lock, has_space);
    if (!problem_.empty()) return;
    if (!has_space()) {
      ++dropped_[std::get<Message>(item).channel];
      return;
    }
    waiting_bytes_ += bytes;
    waiting_.push_back(std::move(item));
  }
  news_.notify_one();
}

std::string McapQueue::problem() const {
  const std::scoped_lock lock{mutex_};
  return problem_;
}

std::map<std::uint16_t, std::uint64_t> McapQueue::dropped() const {
  const std::scoped_lock lock{mutex_};
  return dropped_;
}

void McapQueue::close() {
  end_thread();
  if (!problem_.empty()) throw std::runtime_error(problem_);
  end_file();
}

void McapQueue::run() {
  auto chunk_end = std::chrono::steady_clock::now() + kLongestChunk;
  std::unique_lock lock{mutex_};
  while (!ends_ || !waiting_.empty()) {
    news_.wait_until(lock, chunk_end, [this] { return ends_ || !waiting_.empty(); });
    std::deque<Item> taken = std::exchange(waiting_, {});
    lock.unlock();
    std::string problem;
    try {
      for (; !taken.empty(); taken.pop_front()) {
        const std::size_t bytes = bytes_of(taken.front());
        handle(taken.front());
        give_back(bytes);
      }
      if (std::chrono::steady_clock::now() >= chunk_end) {
        if (writer_) writer_->end_chunk();
        chunk_end = std::chrono::steady_clock::now() + kLongestChunk;
      }
    } catch (const std::exception& error) {
      problem = error.what();
    }
    lock.lock();
    problem_ = std::move(problem);
    if (problem_.empty()) continue;
    space_.notify_all();
    return;
  }
}

void McapQueue::give_back(std::size_t bytes) {
  {
    const std::scoped_lock lock{mutex_};
    waiting_bytes_ -= bytes;
  }
  space_.notify_all();
}

void McapQueue::handle(Item& item) {
  auto* message = std::get_if<Message>(&item);
  if (const auto* mark = std::get_if<Mark>(&item)) {
    if (around_) begin_around(mark->moment);
  } else if (!message) {
    if (writer_) write(item);
    if (around_) preamble_.push_back(std::move(item));
  } else if (around_ && writer_ && message->log_time > until_) {
    end_file();
    keep(*message);
  } else if (writer_) {
    write(item);
    if (around_) remember(preamble_, std::move(*message));
  } else {
    keep(*message);
  }
}

void McapQueue::write(const Item& item) {
  if (const auto* message = std::get_if<Message>(&item)) {
    writer_->write(message->channel, message->sequence, message->log_time, message->publish_time,
                   message->data);
  } else if (const auto* schema = std::get_if<McapSchema>(&item)) {
    writer_->add(*schema);
  } else if (const auto* channel = std::get_if<McapChannel>(&item)) {
    writer_->add(*channel);
  } else if (const auto* metadata = std::get_if<McapMetadata>(&item)) {
    writer_->add(*metadata);
  } else if (const auto* attachment = std::get_if<McapAttachment>(&item)) {
    writer_->attach(*attachment);
  }
}

void McapQueue::keep(Message& message) {
  const Time oldest = message.log_time - around_->before_and_after;
  kept_bytes_ += sizeof message + message.data.size();
  kept_.push_back(std::move(message));
  while (!kept_.empty() && (kept_.front().log_time < oldest || kept_bytes_ > kMaxWaiting)) {
    kept_bytes_ -= sizeof message + kept_.front().data.size();
    remember(preamble_, std::move(kept_.front()));
    kept_.pop_front();
  }
}

void McapQueue::open(const std::filesystem::path& file) { writer_.emplace(file, options_); }

void McapQueue::begin_around(Time moment) {
  until_ = std::max(until_, moment + around_->before_and_after);
  if (writer_) return;
  open(around_->file(moment));
  // A file is as long as what happened in it: what is older arrives at its beginning.
  Time begin = moment - around_->before_and_after;
  if (!kept_.empty()) begin = std::min(begin, kept_.front().log_time);
  for (const Item& item : preamble_) {
    if (const auto* message = std::get_if<Message>(&item)) {
      writer_->write(message->channel, message->sequence, std::max(message->log_time, begin),
                     message->publish_time, message->data);
    } else {
      write(item);
    }
  }
  for (Message& message : kept_) {
    Item item{std::move(message)};
    write(item);
    remember(preamble_, std::move(std::get<Message>(item)));
  }
  kept_.clear();
  kept_bytes_ = 0;
}

void McapQueue::end_file() {
  if (!writer_) return;
  writer_->close();
  messages_ += writer_->messages();
  bytes_ += writer_->bytes();
  head_ = to_hex(writer_->head());
  const std::filesystem::path file = writer_->file();
  writer_.reset();
  if (around_) around_->told(file);
}

}  // namespace armature
