// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/mcap_reader.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

namespace armature {
namespace {

using mcap::Op;

constexpr std::uint64_t kLargestChunk = std::uint64_t{1} << 30;  // [byte], unpacked
constexpr std::uint64_t kRecordHead = 9;                         // [byte] op and length

std::uint32_t checksum_of(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::span<const std::byte> map_file(const std::filesystem::path& file) {
  const auto refuse = [&] {
    throw std::runtime_error(
        fmt::format("cannot read '{}': {}", file.string(), std::generic_category().message(errno)));
  };
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) refuse();
  struct stat about {};
  const bool known = fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode);
  const auto size = static_cast<std::size_t>(known ? about.st_size : 0);
  void* memory = size == 0 ? nullptr : mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  close(descriptor);
  if (memory == MAP_FAILED) refuse();
  return {static_cast<const std::byte*>(memory), size};
}

}  // namespace

/// Reads the parts of a record. Past its end it reads zeros and remembers that it failed.
class McapReader::Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes) : left_{bytes} {}

  bool ok() const { return ok_; }
  std::span<const std::byte> left() const { return left_; }
  std::span<const std::byte> take(std::uint64_t size) {
    ok_ = ok_ && size <= left_.size();
    if (!ok_) return {};
    const auto taken = left_.first(size);
    left_ = left_.subspan(size);
    return taken;
  }
  template <class Number>
  Number number() {
    Number number{};
    if (const auto bytes = take(sizeof number); ok_) {
      std::memcpy(&number, bytes.data(), sizeof number);
    }
    return number;
  }
  std::string text() { return text_of(take(number<std::uint32_t>())); }
  std::string long_text() { return text_of(take(number<std::uint64_t>())); }
  std::map<std::string, std::string> map() {
    std::map<std::string, std::string> map;
    Cursor inside{take(number<std::uint32_t>())};
    while (inside.ok() && !inside.left().empty()) {
      std::string key = inside.text();
      map[std::move(key)] = inside.text();
    }
    ok_ = ok_ && inside.ok();
    return map;
  }
  Time time() { return Time{number<std::int64_t>()}; }

 private:
  static std::string text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  std::span<const std::byte> left_;
  bool ok_ = true;
};

McapReader::McapReader(const std::filesystem::path& file)
    : file_{map_file(file)}, name_{file.string()} {
  Cursor start{file_};
  const auto magic = start.take(mcap::kMagic.size());
  if (magic.empty() || std::memcmp(magic.data(), mcap::kMagic.data(), magic.size()) != 0) {
    if (!file_.empty()) munmap(const_cast<std::byte*>(file_.data()), file_.size());
    throw std::runtime_error(fmt::format("'{}' is no MCAP file", file.string()));
  }
  position_ = mcap::kMagic.size();
}

McapReader::~McapReader() { munmap(const_cast<std::byte*>(file_.data()), file_.size()); }

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

/// Reads a record of the running chunk; true when it is a message.
bool McapReader::read_message(McapMessage& message) {
  Cursor cursor{chunk_};
  const auto op = static_cast<Op>(cursor.number<std::uint8_t>());
  Cursor record{cursor.take(cursor.number<std::uint64_t>())};
  if (!cursor.ok()) {
    chunk_ = {};
    note(fmt::format("a record of the chunk at byte {} is longer than the chunk", chunk_at_));
    return false;
  }
  chunk_ = cursor.left();
  if (op == Op::schema) add_schema(record);
  if (op == Op::channel) add_channel(record);
  if (op != Op::message) return false;
  const auto channel = channels_.find(record.number<std::uint16_t>());
  message.sequence = record.number<std::uint32_t>();
  message.log_time = record.time();
  message.publish_time = record.time();
  message.data = record.left();
  if (record.ok() && channel != channels_.end()) {
    message.channel = &channel->second;
    return true;
  }
  note(fmt::format("a message of the chunk at byte {} {}", chunk_at_,
                   record.ok() ? "has no channel" : "is too short"));
  return false;
}

bool McapReader::read_record() {
  const std::uint64_t at = position_;
  Cursor cursor{file_.subspan(position_)};
  const auto op = static_cast<Op>(cursor.number<std::uint8_t>());
  Cursor record{cursor.take(cursor.number<std::uint64_t>())};
  if (!cursor.ok()) {
    const bool cut = position_ < file_.size();
    note(fmt::format("it ends {}, at byte {}",
                     cut ? "in the midst of a record" : "before its summary", position_));
    ended_ = true;
    return false;
  }
  position_ += kRecordHead + record.left().size();
  switch (op) {
    case Op::header:
      record.text();
      library_ = record.text();
      break;
    case Op::schema:
      add_schema(record);
      break;
    case Op::channel:
      add_channel(record);
      break;
    case Op::message:  // outside of a chunk: as a chunk of its own
      chunk_ = file_.subspan(at, position_ - at);
      chunk_at_ = at;
      break;
    case Op::chunk:
      open_chunk(record, at);
      break;
    case Op::attachment:
      read_attachment(record, at);
      break;
    case Op::metadata: {
      std::string name = record.text();
      metadata_.push_back({std::move(name), record.map()});
      break;
    }
    case Op::data_end: {
      const auto crc = record.number<std::uint32_t>();
      if (crc != 0 && crc != checksum_of(file_.first(at))) {
        note("the checksum of its messages is wrong: it was changed");
      }
      check_end();
      ended_ = true;
      break;
    }
    default:
      break;
  }
  return true;
}

void McapReader::open_chunk(Cursor record, std::uint64_t at) {
  record.time();
  record.time();
  const auto size = record.number<std::uint64_t>();
  const auto crc = record.number<std::uint32_t>();
  const std::string compression = record.text();
  const auto packed = record.take(record.number<std::uint64_t>());
  const std::string chunk = fmt::format("the chunk at byte {}", at);
  if (!record.ok() || size > kLargestChunk) return note(chunk + " is broken");
  std::span<const std::byte> unpacked = packed;
  if (compression == "zstd") {
    // Before memory is taken for what may be a lie.
    if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != size) {
      return note(chunk + " is broken");
    }
    unpacked_.resize(size);
    const std::size_t got = ZSTD_decompress(unpacked_.data(), size, packed.data(), packed.size());
    unpacked = std::span{unpacked_}.first(ZSTD_isError(got) != 0 ? 0 : got);
  } else if (!compression.empty()) {
    throw std::runtime_error(
        fmt::format("'{}' cannot be read: {} is packed with '{}', only zstd "
                    "is known here",
                    name_, chunk, compression));
  }
  if (unpacked.size() != size) return note(chunk + " is broken");
  if (crc != 0 && crc != checksum_of(unpacked)) return note(chunk + " has a wrong checksum");
  chunk_ = unpacked;
  chunk_at_ = at;
  ++chunks_;
  packed_bytes_ += packed.size();
  unpacked_bytes_ += size;
}

void McapReader::read_attachment(Cursor record, std::uint64_t at) {
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

void McapReader::add_schema(Cursor record) {
  McapSchema schema{.id = record.number<std::uint16_t>()};
  schema.name = record.text();
  schema.encoding = record.text();
  schema.data = record.text();
  if (record.ok()) schemas_[schema.id] = std::move(schema);
}

void McapReader::add_channel(Cursor record) {
  McapChannel channel{.id = record.number<std::uint16_t>(),
                      .schema_id = record.number<std::uint16_t>()};
  channel.topic = record.text();
  channel.message_encoding = record.text();
  channel.metadata = record.map();
  if (record.ok()) channels_[channel.id] = std::move(channel);
}

void McapReader::check_end() {
  const std::uint64_t start = position_;
  std::uint64_t footer_end = 0;
  std::uint32_t crc = 0;
  for (Cursor cursor{file_.subspan(start)}; cursor.ok() && footer_end == 0;) {
    const auto op = static_cast<Op>(cursor.number<std::uint8_t>());
    Cursor record{cursor.take(cursor.number<std::uint64_t>())};
    if (!cursor.ok() || op != Op::footer) continue;
    record.take(2 * sizeof(std::uint64_t));
    crc = record.number<std::uint32_t>();
    footer_end = file_.size() - cursor.left().size();
  }
  if (footer_end == 0) return note("it ends in the midst of its summary");
  const auto summed = file_.subspan(start, footer_end - sizeof crc - start);
  if (crc != 0 && crc != checksum_of(summed)) note("the checksum of its summary is wrong");
  const auto behind = file_.subspan(footer_end);
  if (behind.size() < mcap::kMagic.size() ||
      std::memcmp(behind.data(), mcap::kMagic.data(), mcap::kMagic.size()) != 0) {
    return note("its last bytes are missing");
  }
  if (behind.size() > mcap::kMagic.size()) note("something stands behind its end");
}

void McapReader::note(std::string problem) {
  constexpr std::size_t kMostProblems = 100;
  if (problems_.size() < kMostProblems) problems_.push_back(std::move(problem));
}

}  // namespace armature
