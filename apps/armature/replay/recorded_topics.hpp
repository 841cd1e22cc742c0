// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/web/playback.hpp"
#include "armature/web/topic_source.hpp"

namespace armature {

/// The topics of a recording under their own names and at their own times, played from its
/// beginning as soon as somebody watches one of them. No DDS is in it. One thread.
class RecordedTopics final : public TopicSource, public Playback {
 public:
  struct Options {
    float rate = 1;     // times as fast as it was
    Duration from{0};   // since the beginning, where it is at first
    bool loop = false;  // begins again at its end
  };

  /// Reads the whole file once, to know what is where. Throws std::runtime_error for a file that
  /// cannot be read, is no MCAP file, or has no message after `from`.
  RecordedTopics(const std::filesystem::path& file, const Options& options);

  // Of TopicSource; a topic is handed on by request() and advance(), and by watch() what was so at
  // the present time.
  std::vector<Topic> topics() const override;
  Schema schema_of(const Topic& topic) const override;
  bool watch(const std::string& name, OnMessage on_message) override;
  void unwatch(const std::string& name) override;

  // Of Playback.
  Time first() const override { return first_; }
  Time last() const override { return last_; }
  State state() const override;
  bool request(const Request& request) override;
  Advance advance() override;

  /// What is wrong with the file: "it ends in the midst of a record, at byte 1234".
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  struct Chunk {
    std::uint64_t at = 0;          // [byte]
    std::uint64_t messages = 0;    // in it
    Time last;                     // of all messages up to its end
    std::set<std::string> topics;  // that have messages in it
  };
  struct RecordedTopic {
    Topic topic;
    Schema schema;
  };
  /// What was written of a topic, oldest first.
  struct Past {
    struct Message {
      Time time;
      std::vector<std::byte> cdr;
    };
    std::deque<Message> messages;
    std::size_t wanted = 1;
  };

  void read_all();
  /// The next message of the file; of what is recorded twice, in a joined recording, the one that
  /// its writer has recorded.
  std::optional<McapMessage> read();
  /// A topic is shown as the type of its first message.
  bool is_of_another_type(const McapChannel& channel);
  void add_topics();
  /// Hands on what was written last of `names` until `time`.
  void tell_past(const std::set<std::string>& names, Time time);
  /// Puts messages of a chunk before what is known of later ones.
  void add_past(const Chunk& chunk, Time time, std::map<std::string, Past>& past);
  void hand_on(const std::string& name, const Message& message) const;
  void read_next();
  /// Makes the first message after `time` the next one.
  void find_next(Time time);
  /// Reads the next message again after others were read.
  void find_again();
  void jump(Time time);
  Time now() const;
  /// The position stands from now on where it is, until it is told to move.
  void settle();

  McapReader reader_;
  const RecordedCopies copies_;
  const bool loops_;
  std::vector<Chunk> chunks_;
  std::map<std::string, RecordedTopic> topics_;
  std::map<std::string, std::string> types_;          // of topics
  std::map<std::uint16_t, bool> is_of_another_type_;  // by channel
  std::vector<std::string> problems_;
  Time first_, last_, start_;

  std::map<std::string, OnMessage> watched_;
  std::optional<McapMessage> next_;  // nothing: the recording is over
  std::uint64_t next_chunk_ = 0;     // where it stands [byte]; 0: before the first chunk
  std::uint64_t next_of_chunk_ = 0;  // its number among the messages of the chunk
  Status status_ = Status::paused;
  bool begun_ = false;
  float speed_;
  Time at_, since_;  // the recording was at `at_` when the monotonic clock was at `since_`
  Time told_;        // what was written until then has been handed on
};

}  // namespace armature
