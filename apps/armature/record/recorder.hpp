// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "armature/bus/fast_dds/observer.hpp"
#include "armature/recording/mcap_queue.hpp"

namespace armature {

/// Puts samples into a recording; DDS never waits for the disk. What comes faster than it can be
/// written is dropped and counted. The descriptions of deployments that come by are attached: the
/// file that each was made from, its robots and rigs.
class Recorder {
 public:
  Recorder(const std::filesystem::path& file, bool compress);

  /// Any thread; copies the sample.
  void add(const std::string& topic, const ObservedSample& sample);
  /// Why it cannot write any more; empty: all is well. Any thread.
  std::string problem() const { return queue_.problem(); }
  /// Writes what waits, and ends the file. Throws std::runtime_error.
  void close() { queue_.close(); }
  /// Whether the file stands under its name still.
  bool has_its_file() const { return queue_.has_its_file(); }

  /// Those that stand in the file, after close() or when it has thrown.
  std::uint64_t messages() const { return queue_.messages(); }
  /// Those that came to be written and do not stand in the file, though they did not come too fast:
  /// it could not be written any more.
  std::uint64_t unwritten() const;
  std::uint64_t bytes() const { return queue_.bytes(); }
  /// The last hash of the file's chain, after close().
  std::string head() const { return queue_.head(); }
  std::size_t topics() const;
  /// The number of samples that came faster than they could be written, by topic.
  std::map<std::string, std::uint64_t> dropped() const;
  /// The number of samples that were sent and did not arrive, by topic.
  std::map<std::string, std::uint64_t> lost() const;

 private:
  struct Channel {
    std::uint16_t id = 0;
    std::uint32_t messages = 0;
  };
  Channel& channel_of(const std::string& topic, const ObservedSample& sample);
  void attach_new(const ObservedSample& description, Time arrived);

  McapQueue queue_;
  mutable std::mutex mutex_;
  std::map<std::pair<std::string, std::string>, Channel> channels_;  // by topic and type
  std::set<std::string> attached_;                                   // runs
  std::map<std::string, std::uint64_t> lost_;
};

}  // namespace armature
