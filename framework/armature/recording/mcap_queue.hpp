// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "armature/recording/mcap_writer.hpp"

namespace armature ARMATURE_EXPORT {

/// Writes an MCAP file on a thread of its own, so that nobody waits for the disk. Messages that
/// come faster than they can be written are dropped and counted, or waited for; all else is
/// written. Or keeps the last seconds in memory, and writes a file around each moment that is
/// marked. All functions may be called on any thread.
class McapQueue {
 public:
  static constexpr std::size_t kMaxWaiting = 256U << 20;  // [byte]

  enum class WhenFull { drop, wait };
  /// What is kept in memory, at most kMaxWaiting bytes, and written when a moment is marked. Of
  /// channels whose metadata says qos: latched or log, who comes late is given the last messages:
  /// each file begins with those that are older than what is kept, as if they had just arrived.
  struct Around {
    Duration before_and_after;
    /// Of a moment. A file that is there stays: "fault-2.mcap" is taken, "fault-3.mcap", ...
    std::function<std::filesystem::path(Time)> file;
    std::function<void(const std::filesystem::path&)> told;  // which one is whole
  };

  /// Throws std::runtime_error when the file cannot be written.
  McapQueue(const std::filesystem::path& file, McapWriter::Options options, WhenFull when_full);
  McapQueue(Around around, McapWriter::Options options);
  /// Leaves the file without a summary, unless it was closed.
  ~McapQueue();
  McapQueue(const McapQueue&) = delete;
  McapQueue& operator=(const McapQueue&) = delete;

  /// A channel for messages of a type, in CDR, with the schema that the type's description gives;
  /// of a type that is not known here only the name can be told. One topic may have several.
  std::uint16_t add_channel(const std::string& topic, const std::string& dds_type,
                            std::map<std::string, std::string> metadata = {});
  void add(McapMetadata metadata) { put(std::move(metadata)); }
  void attach(McapAttachment attachment) { put(std::move(attachment)); }
  /// A message of a channel, as McapWriter takes it.
  void write(std::uint16_t channel, std::uint32_t sequence, Time log_time, Time publish_time,
             std::vector<std::byte> data);

  /// A moment, by the log time of messages, around which everything is to be written. One that
  /// comes while a file is being written goes into that.
  void mark(Time moment) { put(Mark{moment}); }

  /// Why it cannot write any more; empty: all is well.
  std::string problem() const;
  /// The number of messages that came faster than they could be written, by channel. What comes
  /// after a problem is not among them.
  std::map<std::uint16_t, std::uint64_t> dropped() const;
  /// Writes what waits, and ends the file. Throws std::runtime_error.
  void close();
  /// Whether the file that is written stands under its name still; true when none is. Not while
  /// one around a moment may begin or end.
  bool has_its_file() const { return !writer_ || writer_->has_its_file(); }
  // After `close`, or when it has thrown:
  /// Those that stand in files, also in one that could not be ended.
  std::uint64_t messages() const { return messages_ + (writer_ ? writer_->messages_in_file() : 0); }
  std::uint64_t bytes() const { return bytes_; }
  /// The last hash of the last file's chain; empty: there is none.
  const std::string& head() const { return head_; }

 private:
  struct Message {
    std::uint16_t channel;
    std::uint32_t sequence;
    Time log_time, publish_time;
    std::vector<std::byte> data;
  };
  struct Mark {
    Time moment;
  };
  using Item = std::variant<McapSchema, McapChannel, McapMetadata, McapAttachment, Message, Mark>;

  static std::size_t bytes_of(const Item& item);
  void put(Item item);
  void give_back(std::size_t bytes);
  void end_thread();
  void run();
  void handle(Item& item);
  void write(const Item& item);
  void keep(Message& message);
  void open(const std::filesystem::path& file);
  void begin_around(Time moment);
  void end_file();

  McapWriter::Options options_;
  const WhenFull when_full_;
  std::optional<Around> around_;
  // Of the thread:
  std::optional<McapWriter> writer_;  // none: what comes is kept
  Time until_;                        // when the file around a moment ends
  std::vector<Item> preamble_;        // all but messages; of latched channels the last of these
  std::deque<Message> kept_;          // before the next moment
  std::size_t kept_bytes_ = 0;
  std::uint64_t messages_ = 0, bytes_ = 0;  // of files that have ended
  std::string head_;
  // Of all:
  mutable std::mutex mutex_;
  std::condition_variable news_, space_;
  std::deque<Item> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::map<std::string, std::uint16_t> schemas_;  // by type
  std::uint16_t channels_ = 0;
  std::map<std::uint16_t, std::uint64_t> dropped_;
  std::string problem_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace armature
