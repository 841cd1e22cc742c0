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

struct McapMessage {
  const McapChannel* channel;
  std::uint32_t sequence = 0;
  Time log_time, publish_time;
  std::span<const std::byte> data;  // valid until the next message is read
};

/// Reads an MCAP file from its beginning: also one without a summary, whose program died, and one
/// with damaged chunks, which are passed over. Chunks may be uncompressed or packed with zstd. One
/// thread at a time.
class McapReader {
 public:
  /// Throws std::runtime_error for a file that cannot be read or is no MCAP file.
  explicit McapReader(const std::filesystem::path& file);
  ~McapReader();
  McapReader(const McapReader&) = delete;
  McapReader& operator=(const McapReader&) = delete;

  /// The next message, in the order of the file; nothing after the last one. Throws
  /// std::runtime_error for a chunk that is packed with something else.
  std::optional<McapMessage> next();
  /// What has been met so far; all of it after the last message.
  const std::map<std::uint16_t, McapSchema>& schemas() const { return schemas_; }
  const std::map<std::uint16_t, McapChannel>& channels() const { return channels_; }
  const std::vector<McapAttachment>& attachments() const { return attachments_; }
  const std::vector<McapMetadata>& metadata() const { return metadata_; }
  const std::string& library() const { return library_; }
  /// Of all chunks so far, as they stand in the file and unpacked.
  std::uint64_t chunks() const { return chunks_; }
  std::uint64_t packed_bytes() const { return packed_bytes_; }
  std::uint64_t unpacked_bytes() const { return unpacked_bytes_; }
  /// After the last message: what is wrong with the file, "it ends in the midst of a record, at
  /// byte 1234"; empty: it is whole.
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  class Cursor;

  bool read_record();
  bool read_message(McapMessage& message);
  void open_chunk(Cursor record, std::uint64_t at);
  void read_attachment(Cursor record, std::uint64_t at);
  void add_schema(Cursor record);
  void add_channel(Cursor record);
  /// The summary, and what stands behind it, from `data_end` on.
  void check_end();
  void note(std::string problem);

  std::span<const std::byte> file_;  // mapped
  std::uint64_t position_ = 0;
  bool ended_ = false;
  std::vector<std::byte> unpacked_;
  std::span<const std::byte> chunk_;  // what is left of the running one
  std::uint64_t chunk_at_ = 0;
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::vector<McapAttachment> attachments_;
  std::vector<McapMetadata> metadata_;
  std::string name_, library_;
  std::vector<std::string> problems_;
  std::uint64_t chunks_ = 0, packed_bytes_ = 0, unpacked_bytes_ = 0;
};

}  // namespace armature
