// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "armature/recording/mcap.hpp"

namespace armature ARMATURE_EXPORT {

/// What a recording says of itself at its end.
struct McapSummary {
  struct Attachment {
    std::string name;
    std::uint64_t bytes = 0;
  };
  std::string library;
  std::map<std::uint16_t, McapSchema> schemas;
  std::map<std::uint16_t, McapChannel> channels;
  std::map<std::uint16_t, std::uint64_t> messages;  // by channel
  Time first, last;                                 // log times of all
  std::uint64_t chunks = 0, packed_bytes = 0, unpacked_bytes = 0;
  std::vector<Attachment> attachments;
  std::vector<McapMetadata> metadata;
  std::uint64_t links = 0;  // of the chain of hashes; 0: there is none
  std::string head;         // the last hash
};

/// Reads no more of the file than its summary and the metadata, however long it is; whether the
/// rest is as it was written is not looked at. Nothing: it has no summary, or one without
/// statistics, counts of messages by channel, their channels and schemas or indexes of its chunks,
/// or one that tells a channel or schema twice otherwise, or whose checksum is not right. Throws
/// std::runtime_error for a file that cannot be read or is no MCAP file.
std::optional<McapSummary> read_summary(const std::filesystem::path& file);
/// The same of the bytes of an MCAP file.
std::optional<McapSummary> read_summary(std::span<const std::byte> bytes);

}  // namespace armature
