// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "armature/bus/fast_dds/observer.hpp"
#include "armature/recording/mcap_writer.hpp"

namespace armature {

/// Puts samples into a recording on a thread of its own, so that DDS never waits for the disk. What
/// comes faster than it can be written is dropped and counted. The descriptions of deployments that
/// come by are attached: the file that each was made from, its robots and rigs.
class Recorder {
 public:
  static constexpr std::size_t kMostWaiting = 256U << 20;  // [byte]

  Recorder(const std::filesystem::path& file, bool compress);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Any thread; copies the sample.
  void add(const std::string& topic, const ObservedSample& sample);
  /// Why it cannot write any more; empty: all is well. Any thread.
  std::string problem() const;
  /// Writes what waits, and ends the file. Throws std::runtime_error.
  void close();

  std::uint64_t messages() const { return writer_.messages(); }
  std::uint64_t bytes() const { return writer_.bytes(); }
  std::size_t topics() const { return channels_.size(); }
  /// The number of samples that were dropped, by topic.
  std::map<std::string, std::uint64_t> dropped() const;

 private:
  struct Waiting {
    std::string topic, type;
    Time arrived, sent;
    std::vector<std::byte> cdr;
  };
  struct Channel {
    std::uint16_t id = 0;
    std::uint32_t messages = 0;
  };

  void run();
  void write(const Waiting& waiting);
  Channel& channel_of(const Waiting& waiting);
  void attach_description(const Waiting& waiting);

  McapWriter writer_;
  std::map<std::string, std::uint16_t> schemas_;  // by type
  std::map<std::string, Channel> channels_;       // by topic
  std::set<std::string> attached_;                // runs
  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::deque<Waiting> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::map<std::string, std::uint64_t> dropped_;
  std::string problem_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace armature
