// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/mcap_summary.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "armature/recording/hash_chain.hpp"
#include "armature/recording/mapped_file.hpp"
#include "armature/recording/mcap_cursor.hpp"

namespace armature {
namespace {

using mcap::Op;
using View = std::span<const std::byte>;

constexpr std::uint64_t kFooterBytes = 1 + 8 + 8 + 8 + 4;

/// The records of the summary, without its footer; nothing when its end is missing or its checksum
/// is not right.
std::optional<View> summary_of(View file) {
  if (file.size() < 2 * mcap::kMagic.size() + kFooterBytes) return std::nullopt;
  const std::uint64_t footer_at = file.size() - mcap::kMagic.size() - kFooterBytes;
  McapRecord footer = next_record(file.subspan(footer_at));
  const auto start = footer.body.number<std::uint64_t>();
  footer.body.number<std::uint64_t>();
  const auto crc = footer.body.number<std::uint32_t>();
  const bool is_one = footer.op == Op::footer && footer.size == kFooterBytes &&
                      mcap::begins_with_magic(file.last(mcap::kMagic.size())) && start != 0 &&
                      start <= footer_at && crc != 0;
  if (!is_one) return std::nullopt;
  const View summed = file.subspan(start, footer_at + kFooterBytes - sizeof crc - start);
  const auto got = crc32_z(0, reinterpret_cast<const Bytef*>(summed.data()), summed.size());
  if (got != crc) return std::nullopt;
  return file.subspan(start, footer_at - start);
}

/// False when what is told of its id already is something else.
template <class Told>
bool is_told_once(std::map<std::uint16_t, Told>& known, const Told& told) {
  return known.try_emplace(told.id, told).first->second == told;
}

struct Statistics {
  std::uint64_t messages = 0;
  std::uint32_t chunks = 0;
};

Statistics read_statistics(McapCursor record, McapSummary& summary) {
  Statistics statistics;
  statistics.messages = record.number<std::uint64_t>();
  record.take(2 + 4 + 4 + 4);  // schemas, channels, attachments, metadata
  statistics.chunks = record.number<std::uint32_t>();
  summary.first = record.time();
  summary.last = record.time();
  McapCursor counts{record.take(record.number<std::uint32_t>())};
  while (counts.ok() && !counts.left().empty()) {
    const auto channel = counts.number<std::uint16_t>();
    summary.messages[channel] = counts.number<std::uint64_t>();
  }
  return statistics;
}

/// Whether the summary counts all messages by channel, and has these channels and their schemas: a
/// writer may leave them out.
bool counts_all(const McapSummary& summary, std::uint64_t messages) {
  std::uint64_t counted = 0;
  for (const auto& [id, count] : summary.messages) {
    counted += count;
    const auto channel = summary.channels.find(id);
    if (channel == summary.channels.end()) return false;
    const std::uint16_t schema = channel->second.schema_id;  // 0: it has none
    if (schema != 0 && !summary.schemas.contains(schema)) return false;
  }
  return counted == messages;
}

void read_chunk_index(McapCursor record, McapSummary& summary) {
  record.take(4 * 8);  // times, place, length
  record.take(record.number<std::uint32_t>());
  record.number<std::uint64_t>();
  record.text();
  summary.packed_bytes += record.number<std::uint64_t>();
  summary.unpacked_bytes += record.number<std::uint64_t>();
  ++summary.chunks;
}

void read_attachment_index(McapCursor record, McapSummary& summary) {
  record.take(4 * 8);  // place, length, times
  const auto bytes = record.number<std::uint64_t>();
  summary.attachments.push_back({.name = record.text(), .bytes = bytes});
}

std::optional<ChainRecord> link_in(const McapRecord& record) {
  if (static_cast<std::uint8_t>(record.op) != ChainRecord::kOp) return std::nullopt;
  return ChainRecord::parse(record.body.left());
}

/// The metadata stands elsewhere in the file. `left`: what all that follow may have together
/// [byte]; false when it has more.
bool read_metadata_index(McapCursor record, View file, std::uint64_t& left, McapSummary& summary) {
  const auto at = record.number<std::uint64_t>();
  if (!record.ok() || at > file.size()) return true;
  McapRecord metadata = next_record(file.subspan(at));
  if (metadata.op != Op::metadata || metadata.size == 0) return true;
  if (metadata.size > left) return false;
  left -= metadata.size;
  std::string name = metadata.body.text();
  auto values = metadata.body.map();
  if (metadata.body.ok()) summary.metadata.push_back({std::move(name), std::move(values)});
  return true;
}

}  // namespace

std::optional<McapSummary> read_summary(const std::filesystem::path& file) {
  const MappedFile mapped{file};
  if (!mcap::begins_with_magic(mapped.bytes())) {
    throw std::runtime_error(fmt::format("'{}' is no MCAP file", file.string()));
  }
  return read_summary(mapped.bytes());
}

std::optional<McapSummary> read_summary(std::span<const std::byte> bytes) {
  const auto records = summary_of(bytes);
  if (!records) return std::nullopt;
  McapSummary summary;
  McapRecord header = next_record(bytes.subspan(mcap::kMagic.size()));
  if (header.op == Op::header) {
    header.body.text();
    summary.library = header.body.text();
  }
  std::optional<Statistics> statistics;
  std::uint64_t left_of_metadata = bytes.size();
  for (View left = *records; !left.empty();) {
    McapRecord record = next_record(left);
    if (record.size == 0) return std::nullopt;
    left = left.subspan(record.size);
    if (const auto link = link_in(record)) {
      summary.links = link->number;
      summary.head = to_hex(link->hash);
      break;  // what stands behind it has no hash
    }
    switch (record.op) {
      case Op::schema:
        if (!is_told_once(summary.schemas, read_schema(record.body))) return std::nullopt;
        break;
      case Op::channel:
        if (!is_told_once(summary.channels, read_channel(record.body))) return std::nullopt;
        break;
      case Op::statistics: statistics = read_statistics(record.body, summary); break;
      case Op::chunk_index: read_chunk_index(record.body, summary); break;
      case Op::attachment_index: read_attachment_index(record.body, summary); break;
      case Op::metadata_index:
        // One that is named again and again would take any memory.
        if (!read_metadata_index(record.body, bytes, left_of_metadata, summary)) {
          return std::nullopt;
        }
        break;
      default: break;
    }
  }
  const bool is_complete = statistics && statistics->chunks == summary.chunks &&
                           counts_all(summary, statistics->messages);
  if (!is_complete) return std::nullopt;
  return summary;
}

}  // namespace armature
