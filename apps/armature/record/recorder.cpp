// SPDX-License-Identifier: Apache-2.0
#include "record/recorder.hpp"

#include <chrono>
#include <stdexcept>
#include <utility>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/messages/ros_definition.hpp"
#include "armature/runtime/execution/clock.hpp"

namespace armature {
namespace {

constexpr std::chrono::seconds kLongestChunk{1};  // what is lost when the program dies

}  // namespace

Recorder::Recorder(const std::filesystem::path& file, bool compress)
    : writer_{file, {.library = "armature " ARMATURE_VERSION, .compress = compress}},
      thread_{[this] { run(); }} {}

Recorder::~Recorder() {
  {
    const std::scoped_lock lock{mutex_};
    ends_ = true;
  }
  news_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Recorder::add(const std::string& topic, const ObservedSample& sample) {
  const Time now = SystemClock{}.now();
  {
    const std::scoped_lock lock{mutex_};
    if (waiting_bytes_ + sample.cdr.size() > kMostWaiting || !problem_.empty()) {
      ++dropped_[topic];
      return;
    }
    waiting_bytes_ += sample.cdr.size();
    waiting_.push_back({.topic = topic,
                        .type = sample.type,
                        .arrived = now,
                        .sent = sample.source,
                        .cdr = {sample.cdr.begin(), sample.cdr.end()}});
  }
  news_.notify_one();
}

std::string Recorder::problem() const {
  const std::scoped_lock lock{mutex_};
  return problem_;
}

std::map<std::string, std::uint64_t> Recorder::dropped() const {
  const std::scoped_lock lock{mutex_};
  return dropped_;
}

void Recorder::close() {
  {
    const std::scoped_lock lock{mutex_};
    ends_ = true;
  }
  news_.notify_one();
  thread_.join();
  if (!problem_.empty()) throw std::runtime_error(problem_);
  writer_.close();
}

void Recorder::run() {
  auto chunk_end = std::chrono::steady_clock::now() + kLongestChunk;
  std::unique_lock lock{mutex_};
  while (!ends_ || !waiting_.empty()) {
    news_.wait_until(lock, chunk_end, [this] { return ends_ || !waiting_.empty(); });
    std::deque<Waiting> taken = std::exchange(waiting_, {});
    lock.unlock();
    std::size_t bytes = 0;
    std::string problem;
    try {
      for (const Waiting& waiting : taken) {
        write(waiting);
        bytes += waiting.cdr.size();
      }
      if (std::chrono::steady_clock::now() >= chunk_end) {
        writer_.end_chunk();
        chunk_end = std::chrono::steady_clock::now() + kLongestChunk;
      }
    } catch (const std::exception& error) {
      problem = error.what();
    }
    lock.lock();
    waiting_bytes_ -= bytes;
    problem_ = std::move(problem);
    if (!problem_.empty()) return;
  }
}

void Recorder::write(const Waiting& waiting) {
  Channel& channel = channel_of(waiting);
  writer_.write(channel.id, ++channel.messages, waiting.arrived, waiting.sent, waiting.cdr);
  if (waiting.type == message_type<msg::DeploymentDescription>().dds_name) {
    attach_description(waiting);
  }
}

Recorder::Channel& Recorder::channel_of(const Waiting& waiting) {
  if (const auto known = channels_.find(waiting.topic); known != channels_.end()) {
    return known->second;
  }
  const TypeDescription* type = describe_type(waiting.type);
  std::uint16_t schema = 0;  // none
  if (type) {
    const auto [place, is_new] = schemas_.try_emplace(waiting.type, 0);
    if (is_new) {
      place->second = writer_.add(McapSchema{
          .name = ros2_name(*type), .encoding = "ros2msg", .data = ros_definition(*type)});
    }
    schema = place->second;
  }
  const std::uint16_t id = writer_.add(McapChannel{.schema_id = schema,
                                                   .topic = waiting.topic,
                                                   .message_encoding = "cdr",
                                                   .metadata = {{"dds_type", waiting.type}}});
  return channels_.emplace(waiting.topic, Channel{.id = id}).first->second;
}

void Recorder::attach_description(const Waiting& waiting) {
  msg::DeploymentDescription told;
  if (!message_type<msg::DeploymentDescription>().decode(waiting.cdr, &told)) return;
  // All processes of a run tell the same files.
  if (!attached_.insert(told.deployment_() + " " + told.run_()).second) return;
  const auto attach = [&](const std::string& name, const std::string& text) {
    writer_.attach({.log_time = waiting.arrived,
                    .create_time = waiting.sent,
                    .name = told.deployment_() + "/" + name + ".yaml",
                    .media_type = "application/yaml",
                    .data = text});
  };
  attach(told.deployment_(), told.configuration_());
  for (const auto& document : told.documents_()) {
    attach(document.section_() + "/" + document.name_(), document.text_());
  }
  writer_.add(McapMetadata{.name = "armature.deployment",
                           .values = {{"deployment", told.deployment_()},
                                      {"fingerprint", told.fingerprint_()},
                                      {"run", told.run_()},
                                      {"version", told.version_()},
                                      {"clock", told.simulated_() ? "simulated" : "system"}}});
}

}  // namespace armature
