// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "armature/recording/chain_check.hpp"
#include "armature/recording/mcap.hpp"

namespace armature ARMATURE_EXPORT {

class MappedFile;
class McapCursor;

struct McapMessage {
  const McapChannel* channel;
  std::uint32_t sequence = 0;
  Time log_time, publish_time;
  std::span<const std::byte> data;  // valid until the next message is read
};

/// Reads an MCAP file from its beginning: also one without a summary, whose program died, and one
/// with damaged chunks, which are passed over. Chunks may be uncompressed or packed with zstd. It
/// takes memory for one unpacked chunk, of at most 1 GiB, and for the attachments. One thread at a
/// time.
class McapReader {
 public:
  /// `follow_chain`: the hash of every byte is made, and chain() tells what came of it. Throws
  /// std::runtime_error for a file that cannot be read or is no MCAP file.
  explicit McapReader(const std::filesystem::path& file, bool follow_chain = false);
  ~McapReader();
  McapReader(const McapReader&) = delete;
  McapReader& operator=(const McapReader&) = delete;

  /// The next message, in the order of the file; nothing after the last one. Throws
  /// std::runtime_error for a chunk that is packed with lz4.
  std::optional<McapMessage> next();
  /// Where the chunk of the last message begins [byte].
  std::uint64_t chunk() const { return chunk_at_; }
  /// Goes on with the first message of a chunk that chunk() has told. What is met twice is counted
  /// twice: problems() and the numbers of chunks and bytes mean nothing afterwards. Not for a
  /// reader that follows the chain.
  void go_to(std::uint64_t chunk);
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
  /// After the last message, when the chain was followed.
  McapChain chain() const { return chain_ ? chain_->result() : McapChain{}; }

 private:
  bool read_record();
  bool pass_over_damage();
  bool read_message(McapMessage& message);
  void check_times(const McapMessage& message);
  void check_schema(const McapChannel& channel);
  void open_chunk(McapCursor record, std::uint64_t at);
  std::span<const std::byte> unpack(std::span<const std::byte> packed, std::uint64_t size);
  void read_attachment(McapCursor record, std::uint64_t at);
  void read_metadata(McapCursor record, std::uint64_t at);
  void add_schema(McapCursor record, std::uint64_t at);
  void add_channel(McapCursor record, std::uint64_t at);
  const McapChannel* find_channel(std::uint16_t id);
  /// The summary, and what stands behind it, from `data_end` on.
  void check_end();
  void check_statistics(McapCursor record);
  void note(std::string problem);

  std::unique_ptr<MappedFile> mapped_;
  std::span<const std::byte> file_;
  std::optional<ChainCheck> chain_;
  std::uint64_t position_ = 0;
  bool ended_ = false;
  std::unique_ptr<std::byte[]> unpacked_;
  std::uint64_t room_ = 0;            // there
  std::span<const std::byte> chunk_;  // what is left of the running one
  std::uint64_t chunk_at_ = 0;
  bool has_bounds_ = false;  // of the log times in the running chunk
  Time chunk_first_, chunk_last_;
  std::uint64_t messages_ = 0, messages_of_chunk_ = 0;
  std::map<std::uint16_t, McapSchema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::set<std::uint16_t> checked_channels_;
  bool has_asked_summary_ = false;
  std::vector<McapAttachment> attachments_;
  std::vector<McapMetadata> metadata_;
  std::string name_, library_;
  std::vector<std::string> problems_;
  std::uint64_t chunks_ = 0, packed_bytes_ = 0, unpacked_bytes_ = 0;
};

}  // namespace armature
