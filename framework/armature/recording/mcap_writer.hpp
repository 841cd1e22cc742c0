// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "armature/recording/hash_chain.hpp"
#include "armature/recording/mcap.hpp"

namespace armature ARMATURE_EXPORT {

/// Writes an MCAP file: messages in chunks, each with its index and CRC, and a summary at the end,
/// so that viewers seek in it, all in a chain of hashes. What stands in the file when the program
/// dies, or the disk is full, is readable to its last chunk. Every function throws
/// std::runtime_error with the file's name and the system's reason when writing fails, and the file
/// takes nothing from then on; so it is when the file was removed, moved or replaced meanwhile,
/// which is found when a chunk ends and when the file is closed. A file that another writer has
/// open is refused, and stays as it is. One thread at a time; not real-time safe.
class McapWriter {
 public:
  struct Options {
    std::string library = "armature";
    bool compress = true;                // chunks, with zstd
    std::size_t chunk_bytes = 1U << 20;  // of messages, until a chunk is written
    bool chain = true;                   // of hashes, by which a change is found
    /// A file that is there stays, and "fault-2.mcap" is taken, "fault-3.mcap" and so on; else it
    /// is replaced.
    bool keeps_older = false;
  };

  McapWriter(std::filesystem::path file, Options options);
  /// Leaves the file as it is: without a summary, unless it was closed.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Their ids are given here.
  std::uint16_t add(McapSchema schema);
  std::uint16_t add(McapChannel channel);
  /// A message of a channel; its bytes include CDR's encapsulation header.
  void write(std::uint16_t channel, std::uint32_t sequence, Time log_time, Time publish_time,
             std::span<const std::byte> data);
  /// Writes what has been kept for the running chunk.
  void end_chunk();
  void attach(const McapAttachment& attachment);
  void add(const McapMetadata& metadata);
  /// Ends the file, with its summary.
  void close();

  /// Where it stands.
  const std::filesystem::path& file() const { return file_; }
  /// Whether what is written stands there still; true of what is no regular file. Until close().
  bool has_its_file() const;
  std::uint64_t messages() const { return messages_; }
  /// Those of them whose chunk stands in the file: readable, whatever becomes of the rest.
  std::uint64_t messages_in_file() const { return messages_in_file_; }
  std::uint64_t bytes() const { return position_; }
  /// How many links of the chain stand in the file, and the hash of the last one. After close() it
  /// tells the whole file from every other.
  std::uint64_t links() const { return links_; }
  const Hash& head() const { return head_; }

 private:
  /// Makes the file, under another name where it is there and is to stay.
  void create();

  using Bytes = std::vector<std::byte>;
  struct IndexEntry {
    std::int64_t time;
    std::uint64_t offset;  // in the uncompressed chunk
  };
  struct Chunk {
    Time first, last;
    Bytes records;
    std::map<std::uint16_t, std::vector<IndexEntry>> index;
  };
  class Zstd;

  void put(std::span<const std::byte> bytes);
  void check_file();
  /// Writes what is part of the chain.
  void put_hashed(std::span<const std::byte> bytes);
  /// All that was written since the last link is one now.
  void put_link();
  void put_summary();
  void put_group(mcap::Op op, const std::vector<Bytes>& records, Bytes& summary, Bytes& offsets,
                 std::uint64_t start) const;

  std::filesystem::path file_;
  Options options_;
  int descriptor_ = -1;
  bool broken_ = false;
  std::uint64_t position_ = 0, messages_ = 0, messages_in_file_ = 0;
  std::uint32_t crc_ = 0;  // of all that stands in the file
  Time first_, last_;
  std::optional<HashChain> chain_;
  std::uint64_t links_ = 0;
  Hash head_{};
  Chunk chunk_;
  Bytes packed_;
  std::unique_ptr<Zstd> zstd_;
  // For the summary, as they stand there.
  std::vector<Bytes> schemas_, channels_, chunk_indexes_, attachment_indexes_, metadata_indexes_;
  std::map<std::uint16_t, std::uint64_t> counts_;  // messages of a channel
};

}  // namespace armature
