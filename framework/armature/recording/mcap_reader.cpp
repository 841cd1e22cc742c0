// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/mcap_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>
#include <zstd.h>

#include <new>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "armature/recording/mapped_file.hpp"
#include "armature/recording/mcap_cursor.hpp"
#include "armature/recording/mcap_summary.hpp"

namespace armature {
namespace {

using mcap::Op;

constexpr std::uint64_t kLargestChunk = std::uint64_t{1} << 30;  // [byte], unpacked

std::uint32_t checksum_of(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

const std::string& name_of(const McapSchema& schema) { return schema.name; }
const std::string& name_of(const McapChannel& channel) { return channel.topic; }

/// The difference beside the name.
std::vector<std::string_view> differences(const McapSchema& a, const McapSchema& b) {
  std::vector<std::string_view> parts;
  if (a.encoding != b.encoding) parts.emplace_back("another encoding");
  if (a.data != b.data) parts.emplace_back("another text");
  return parts;
}

std::vector<std::string_view> differences(const McapChannel& a, const McapChannel& b) {
  std::vector<std::string_view> parts;
  if (a.schema_id != b.schema_id) parts.emplace_back("another schema");
  if (a.message_encoding != b.message_encoding) parts.emplace_back("another encoding");
  if (a.metadata != b.metadata) parts.emplace_back("other metadata");
  return parts;
}

/// Keeps what is told of an id first. What is wrong when it is told otherwise again, `at` that
/// byte; empty: it is not.
template <class Told>
std::string keep_first(std::map<std::uint16_t, Told>& known, const Told& told,
                       std::string_view what, std::uint64_t at) {
  const auto [place, is_new] = known.try_emplace(told.id, told);
  const Told& first = place->second;
  if (is_new || first == told) return "";
  if (name_of(first) != name_of(told)) {
    return fmt::format(
        "{} {} is told twice: at byte {} it is '{}', and before it was '{}', which "
        "counts",
        what, told.id, at, name_of(told), name_of(first));
  }
  return fmt::format(
      "{} {}, '{}', is told twice: at byte {} it has {} than before, and "
      "what was before counts",
      what, told.id, name_of(told), at, fmt::join(differences(first, told), " and "));
}

}  // namespace

McapReader::McapReader(const std::filesystem::path& file, bool follow_chain)
    : mapped_{std::make_unique<MappedFile>(file)}, file_{mapped_->bytes()}, name_{file.string()} {
  if (!mcap::begins_with_magic(file_)) {
    throw std::runtime_error(fmt::format("'{}' is no MCAP file", file.string()));
  }
  position_ = mcap::kMagic.size();
  if (follow_chain) chain_.emplace(file_);
}

McapReader::~McapReader() = default;

std::optional<McapMessage> McapReader::next() {
  McapMessage message;
  while (true) {
    if (!chunk_.empty()) {
      if (read_message(message)) return message;
    } else if (ended_ || !read_record()) {
      return std::nullopt;
    }
  }
}

void McapReader::go_to(std::uint64_t chunk) {
  position_ = chunk;
  chunk_ = {};
  ended_ = false;
}

/// Reads a record of the running chunk; true when it is a message.
bool McapReader::read_message(McapMessage& message) {
  McapRecord next = next_record(chunk_);
  if (next.size == 0) {
    chunk_ = {};
    note(fmt::format("a record of the chunk at byte {} is longer than the chunk", chunk_at_));
    return false;
  }
  chunk_ = chunk_.subspan(next.size);
  McapCursor& record = next.body;
  if (next.op == Op::schema) add_schema(record, chunk_at_);
  if (next.op == Op::channel) add_channel(record, chunk_at_);
  if (next.op != Op::message) return false;
  const auto id = record.number<std::uint16_t>();
  message.channel = find_channel(id);
  message.sequence = record.number<std::uint32_t>();
  message.log_time = record.time();
  message.publish_time = record.time();
  message.data = record.left();
  ++messages_;
  ++messages_of_chunk_;
  if (!record.ok() || !message.channel) {
    note(fmt::format(
        "message {} of the chunk at byte {} {}", messages_of_chunk_, chunk_at_,
        record.ok() ? fmt::format("is of channel {}, which is not there", id) : "is too short"));
    return false;
  }
  check_times(message);
  check_schema(*message.channel);
  return true;
}

void McapReader::check_times(const McapMessage& message) {
  const std::int64_t ns = message.log_time.ns;
  const auto where = [&] {
    return fmt::format("message {} of the chunk at byte {}, of '{}', has the log time",
                       messages_of_chunk_, chunk_at_, message.channel->topic);
  };
  if (ns < 0) {
    note(fmt::format("{} {} ns, which no clock tells", where(), static_cast<std::uint64_t>(ns)));
  } else if (has_bounds_ && (message.log_time < chunk_first_ || message.log_time > chunk_last_)) {
    note(fmt::format("{} {} ns, and the chunk says that its times are from {} to {} ns", where(),
                     ns, chunk_first_.ns, chunk_last_.ns));
  }
}

/// CDR does not say what it is: without a schema nobody can read it.
void McapReader::check_schema(const McapChannel& channel) {
  if (!checked_channels_.insert(channel.id).second || channel.message_encoding != "cdr") return;
  if (schemas_.contains(channel.schema_id)) return;
  note(fmt::format("channel {}, '{}', is of encoding cdr and names {}", channel.id, channel.topic,
                   channel.schema_id == 0
                       ? "no schema"
                       : fmt::format("schema {}, which is not there", channel.schema_id)));
}

bool McapReader::read_record() {
  const std::uint64_t at = position_;
  const McapRecord record = next_record(file_.subspan(position_));
  if (record.size == 0) return pass_over_damage();
  position_ += record.size;
  if (chain_) chain_->take(static_cast<std::uint8_t>(record.op), record.body.left(), position_);
  McapCursor body = record.body;
  switch (record.op) {
    case Op::header:
      body.text();
      library_ = body.text();
      break;
    case Op::schema: add_schema(body, at); break;
    case Op::channel: add_channel(body, at); break;
    case Op::message:  // outside of a chunk: as a chunk of its own
      chunk_ = file_.subspan(at, position_ - at);
      chunk_at_ = at;
      has_bounds_ = false;
      messages_of_chunk_ = 0;
      break;
    case Op::chunk: open_chunk(body, at); break;
    case Op::attachment: read_attachment(body, at); break;
    case Op::metadata: read_metadata(body, at); break;
    case Op::data_end: {
      const auto crc = body.number<std::uint32_t>();
      if (crc != 0 && crc != checksum_of(file_.first(at))) {
        note("the checksum of its messages is wrong: it was changed");
      }
      check_end();
      ended_ = true;
      break;
    }
    default: break;
  }
  return true;
}

/// Where no record can be read: goes on behind the next link of the chain, if there is one. False:
/// the file ends here.
bool McapReader::pass_over_damage() {
  const auto left = file_.subspan(position_);
  const auto link = left.empty() ? std::nullopt : ChainRecord::find(left.subspan(1));
  if (!link) {
    note(fmt::format("it ends {}, at byte {}",
                     left.empty() ? "before its summary" : "in the midst of a record", position_));
    ended_ = true;
    return false;
  }
  const std::uint64_t from = std::exchange(position_, position_ + 1 + *link);
  note(fmt::format("the record at byte {} is damaged: it was passed over, to byte {}", from,
                   position_));
  if (chain_) chain_->skip(position_);
  return true;
}

void McapReader::open_chunk(McapCursor record, std::uint64_t at) {
  chunk_first_ = record.time();
  chunk_last_ = record.time();
  has_bounds_ = true;
  const auto size = record.number<std::uint64_t>();
  const auto crc = record.number<std::uint32_t>();
  const std::string compression = record.text();
  const auto packed = record.take(record.number<std::uint64_t>());
  const std::string chunk = fmt::format("the chunk at byte {}", at);
  if (!record.ok()) return note(chunk + " is broken");
  if (size > kLargestChunk) {
    return note(fmt::format("{} is broken, or has {} bytes: more than {} are not unpacked", chunk,
                            size, kLargestChunk));
  }
  std::span<const std::byte> unpacked = packed;
  if (compression == "zstd") {
    unpacked = unpack(packed, size);
  } else if (compression == "lz4") {
    throw std::runtime_error(
        fmt::format("'{}' cannot be read: {} is packed with '{}', only zstd "
                    "is known here; the program mcap of mcap.dev makes a copy: mcap compress"
                    " FILE -o zstd.mcap",
                    name_, chunk, compression));
  } else if (!compression.empty()) {
    return note(chunk + " is packed with what the format does not know");
  }
  if (unpacked.size() != size) return note(chunk + " is broken");
  if (crc != 0 && crc != checksum_of(unpacked)) return note(chunk + " has a wrong checksum");
  if (chunk_first_ > chunk_last_) {
    note(fmt::format("{} says that its times are from {} to {} ns", chunk, chunk_first_.ns,
                     chunk_last_.ns));
  }
  chunk_ = unpacked;
  chunk_at_ = at;
  messages_of_chunk_ = 0;
  ++chunks_;
  packed_bytes_ += packed.size();
  unpacked_bytes_ += size;
}

/// Fewer bytes than `size` when they are not what was packed.
std::span<const std::byte> McapReader::unpack(std::span<const std::byte> packed,
                                              std::uint64_t size) {
  // Before memory is taken for what may be a lie.
  const auto told = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (told != size && told != ZSTD_CONTENTSIZE_UNKNOWN) return {};
  if (room_ < size) {
    room_ = 0;
    // Not set to zero: memory that nothing is unpacked to costs nothing.
    unpacked_.reset(new (std::nothrow) std::byte[size]);
    if (!unpacked_) return {};
    room_ = size;
  }
  const std::size_t got = ZSTD_decompress(unpacked_.get(), size, packed.data(), packed.size());
  return {unpacked_.get(), ZSTD_isError(got) != 0 ? 0 : got};
}

void McapReader::read_attachment(McapCursor record, std::uint64_t at) {
  const auto all = record.left();
  McapAttachment attachment{.log_time = record.time(), .create_time = record.time()};
  attachment.name = record.text();
  attachment.media_type = record.text();
  attachment.data = record.long_text();
  const auto crc = record.number<std::uint32_t>();
  const bool right =
      record.ok() && (crc == 0 || crc == checksum_of(all.first(all.size() - sizeof crc)));
  if (!right) return note(fmt::format("the attachment at byte {} is broken", at));
  attachments_.push_back(std::move(attachment));
}

void McapReader::read_metadata(McapCursor record, std::uint64_t at) {
  std::string name = record.text();
  McapCursor before = record;
  const auto told = before.number<std::uint32_t>();
  McapMetadata metadata{std::move(name), record.map()};
  if (!record.ok() || !record.left().empty()) {
    return note(fmt::format("the metadata at byte {} has a map of {} bytes that says it has {}", at,
                            before.left().size(), told));
  }
  metadata_.push_back(std::move(metadata));
}

void McapReader::add_schema(McapCursor record, std::uint64_t at) {
  const McapSchema schema = read_schema(record);
  if (!record.ok()) return note(fmt::format("a schema at byte {} is broken", at));
  std::string twice = keep_first(schemas_, schema, "schema", at);
  if (!twice.empty()) note(std::move(twice));
}

void McapReader::add_channel(McapCursor record, std::uint64_t at) {
  const McapChannel channel = read_channel(record);
  if (!record.ok() || !record.left().empty()) {
    return note(fmt::format("a channel at byte {} is broken, or has a map of wrong length", at));
  }
  std::string twice = keep_first(channels_, channel, "channel", at);
  if (!twice.empty()) note(std::move(twice));
}

/// One that was not met where it belongs, or its schema, stood in what was passed over. A summary
/// whose checksum is right repeats them.
const McapChannel* McapReader::find_channel(std::uint16_t id) {
  const auto is_known = [&] {
    const auto channel = channels_.find(id);
    if (channel == channels_.end()) return false;
    return channel->second.schema_id == 0 || schemas_.contains(channel->second.schema_id);
  };
  if (!is_known() && !std::exchange(has_asked_summary_, true)) {
    if (auto summary = read_summary(file_)) {
      schemas_.merge(summary->schemas);
      channels_.merge(summary->channels);
    }
    if (is_known()) note("what is not told of its channels where they begin is in its summary");
  }
  const auto channel = channels_.find(id);
  return channel == channels_.end() ? nullptr : &channel->second;
}

void McapReader::check_end() {
  if (chain_) chain_->data_ended();
  const std::uint64_t start = position_;
  std::optional<std::uint32_t> crc;
  while (!crc) {
    const McapRecord record = next_record(file_.subspan(position_));
    if (record.size == 0) return note("it ends in the midst of its summary");
    position_ += record.size;
    if (chain_) chain_->take(static_cast<std::uint8_t>(record.op), record.body.left(), position_);
    McapCursor body = record.body;
    if (record.op == Op::statistics) check_statistics(body);
    if (record.op != Op::footer) continue;
    body.take(2 * sizeof(std::uint64_t));
    crc = body.number<std::uint32_t>();
  }
  const auto summed = file_.subspan(start, position_ - sizeof *crc - start);
  if (*crc != 0 && *crc != checksum_of(summed)) note("the checksum of its summary is wrong");
  const auto behind = file_.subspan(position_);
  if (!mcap::begins_with_magic(behind)) return note("its last bytes are missing");
  if (behind.size() == mcap::kMagic.size()) return;
  const auto more = behind.subspan(mcap::kMagic.size());
  note(fmt::format("{} of {} bytes stands behind its end, at byte {}, and is not read",
                   mcap::begins_with_magic(more) ? "another recording" : "something", more.size(),
                   position_ + mcap::kMagic.size()));
}

/// Where nothing else is wrong: a chunk that was passed over is missed here, too.
void McapReader::check_statistics(McapCursor record) {
  const auto messages = record.number<std::uint64_t>();
  if (problems_.empty() && record.ok() && messages != messages_) {
    note(fmt::format("its summary tells of {} messages, and it has {}", messages, messages_));
  }
}

void McapReader::note(std::string problem) {
  constexpr std::size_t kMostProblems = 100;
  if (problems_.size() > kMostProblems) return;
  if (problems_.size() == kMostProblems) problem = "more is wrong with it";
  problems_.push_back(std::move(problem));
}

}  // namespace armature
