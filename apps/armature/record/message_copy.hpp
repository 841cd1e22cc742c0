// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>

#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_writer.hpp"

namespace armature {

/// Copies messages from one recording into another, with the channels and schemas that they need.
class MessageCopy {
 public:
  /// Both outlive it.
  MessageCopy(const McapReader& from, McapWriter& to) : from_{from}, to_{to} {}

  void write(const McapMessage& message) {
    const McapChannel& channel = *message.channel;
    if (!channels_.contains(channel.id)) {
      const auto schema = from_.schemas().find(channel.schema_id);
      if (!schemas_.contains(channel.schema_id) && schema != from_.schemas().end()) {
        schemas_[channel.schema_id] = to_.add(schema->second);
      }
      McapChannel copy = channel;
      copy.schema_id = schemas_[channel.schema_id];
      channels_[channel.id] = to_.add(copy);
    }
    to_.write(channels_[channel.id], message.sequence, message.log_time, message.publish_time,
              message.data);
  }

 private:
  const McapReader& from_;
  McapWriter& to_;
  std::map<std::uint16_t, std::uint16_t> schemas_{{0, 0}}, channels_;  // ids there by ids here
};

/// Copies the attachments and the metadata of a recording into another, where they stood among its
/// messages.
class SurroundingsCopy {
 public:
  /// Both outlive it.
  SurroundingsCopy(const McapReader& from, McapWriter& to) : from_{from}, to_{to} {}

  /// Those that have been read since the last time.
  void write() {
    while (attachments_ < from_.attachments().size())
      to_.attach(from_.attachments()[attachments_++]);
    while (metadata_ < from_.metadata().size()) to_.add(from_.metadata()[metadata_++]);
  }

 private:
  const McapReader& from_;
  McapWriter& to_;
  std::size_t attachments_ = 0, metadata_ = 0;
};

}  // namespace armature
