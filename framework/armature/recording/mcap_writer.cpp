// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/mcap_writer.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <concepts>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "armature/recording/file_lock.hpp"

namespace armature {
namespace {

using Bytes = std::vector<std::byte>;
using mcap::Op;

constexpr int kCompression = 1;  // of zstd: the fastest of its ordinary levels

static_assert(std::endian::native == std::endian::little, "as MCAP stores numbers");

/// Bytes behind their count.
struct Counted {
  std::span<const std::byte> bytes;
};

// Fields as MCAP stores them.
void append(Bytes& bytes, std::span<const std::byte> more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}
template <std::integral Number>
void append(Bytes& bytes, Number number) {
  append(bytes, std::as_bytes(std::span{&number, 1}));
}
void append(Bytes& bytes, Time time) { append(bytes, time.ns); }
void append(Bytes& bytes, Counted counted) {
  append(bytes, static_cast<std::uint32_t>(counted.bytes.size()));
  append(bytes, counted.bytes);
}
void append(Bytes& bytes, std::string_view text) {
  append(bytes, Counted{std::as_bytes(std::span{text})});
}
void append(Bytes& bytes, const std::map<std::string, std::string>& map) {
  Bytes inside;
  for (const auto& [key, value] : map) {
    append(inside, std::string_view{key});
    append(inside, std::string_view{value});
  }
  append(bytes, Counted{inside});
}

template <class... Fields>
void append_all(Bytes& bytes, const Fields&... fields) {
  (append(bytes, fields), ...);
}

template <class... Fields>
void append_record(Bytes& bytes, Op op, const Fields&... fields) {
  append(bytes, static_cast<std::uint8_t>(op));
  append(bytes, std::uint64_t{0});
  const std::size_t begin = bytes.size();
  append_all(bytes, fields...);
  const std::uint64_t size = bytes.size() - begin;
  std::memcpy(bytes.data() + begin - sizeof size, &size, sizeof size);
}

template <class List>
std::uint32_t count_of(const List& list) {
  return static_cast<std::uint32_t>(list.size());
}

std::uint32_t crc_of(std::span<const std::byte> bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// What is recorded is about a patient: also a file that was there before becomes its owner's only.
void make_private(int descriptor) {
  struct stat about {};
  const bool is_ours =
      fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode) && about.st_uid == geteuid();
  if (is_ours) fchmod(descriptor, 0600);
}

/// Takes away what a file had before; of what is no regular file there is nothing to take.
void make_empty(int descriptor, const std::filesystem::path& file) {
  struct stat about {};
  if (fstat(descriptor, &about) == 0 && !S_ISREG(about.st_mode)) return;
  if (ftruncate(descriptor, 0) == 0) return;
  throw std::runtime_error(
      fmt::format("cannot write '{}': {}", file.string(), std::generic_category().message(errno)));
}

}  // namespace

class McapWriter::Zstd {
 public:
  Zstd() : context_{ZSTD_createCCtx()} {}
  ~Zstd() { ZSTD_freeCCtx(context_); }
  Zstd(const Zstd&) = delete;
  Zstd& operator=(const Zstd&) = delete;

  void pack(const Bytes& bytes, Bytes& packed) const {
    packed.resize(ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compressCCtx(context_, packed.data(), packed.size(), bytes.data(),
                                               bytes.size(), kCompression);
    if (ZSTD_isError(size)) throw std::runtime_error(ZSTD_getErrorName(size));
    packed.resize(size);
  }

 private:
  ZSTD_CCtx* context_;
};

McapWriter::McapWriter(std::filesystem::path file, Options options)
    : file_{std::move(file)}, options_{std::move(options)}, zstd_{std::make_unique<Zstd>()} {
  create();
  try {  // the destructor of what is not made does not run
    lock_for_writing(descriptor_, file_);
    make_empty(descriptor_, file_);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
  make_private(descriptor_);
  if (options_.chain) chain_.emplace();
  Bytes bytes;
  append(bytes, std::as_bytes(std::span{mcap::kMagic}));
  append_record(bytes, Op::header, std::string_view{"ros2"}, options_.library);
  put_hashed(bytes);
  put_link();
}

void McapWriter::create() {
  constexpr int kMostOfOneName = 10'000;
  const std::filesystem::path named = file_;
  const int if_there = options_.keeps_older ? O_EXCL : 0;
  for (int number = 2; number <= kMostOfOneName; ++number) {
    // A pipe that nobody reads would be waited for, whatever anybody says meanwhile.
    descriptor_ = open(file_.c_str(), O_WRONLY | O_CREAT | if_there | O_CLOEXEC | O_NONBLOCK, 0600);
    if (descriptor_ >= 0) {
      fcntl(descriptor_, F_SETFL, fcntl(descriptor_, F_GETFL) & ~O_NONBLOCK);
      return;
    }
    if (errno == ENXIO) {
      throw std::runtime_error(
          fmt::format("cannot write '{}': it is a pipe that nobody reads", file_.string()));
    }
    if (errno != EEXIST) break;
    file_ = named;
    file_.replace_filename(
        fmt::format("{}-{}{}", named.stem().string(), number, named.extension().string()));
  }
  throw std::runtime_error(
      fmt::format("cannot write '{}': {}", named.string(), std::generic_category().message(errno)));
}

McapWriter::~McapWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void McapWriter::put_hashed(std::span<const std::byte> bytes) {
  put(bytes);
  if (chain_) chain_->add(bytes);
}

void McapWriter::put_link() {
  if (!chain_) return;
  head_ = chain_->end_link();
  put(ChainRecord{.number = ++links_, .hash = head_}.bytes());
}

void McapWriter::put(std::span<const std::byte> bytes) {
  if (broken_) throw std::runtime_error(fmt::format("'{}' takes nothing more", file_.string()));
  std::span<const std::byte> left = bytes;
  while (!left.empty()) {
    const ssize_t written = ::write(descriptor_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      broken_ = true;
      throw std::runtime_error(fmt::format("cannot write '{}': {}", file_.string(),
                                           std::generic_category().message(errno)));
    }
    left = left.subspan(static_cast<std::size_t>(written));
  }
  crc_ = crc_of(bytes, crc_);
  position_ += bytes.size();
}

bool McapWriter::has_its_file() const {
  struct stat written {};
  struct stat named {};
  if (fstat(descriptor_, &written) != 0 || !S_ISREG(written.st_mode)) return true;
  return stat(file_.c_str(), &named) == 0 && named.st_dev == written.st_dev &&
         named.st_ino == written.st_ino;
}

void McapWriter::check_file() {
  if (broken_ || has_its_file()) return;
  broken_ = true;
  messages_in_file_ = 0;
  throw std::runtime_error(
      fmt::format("'{}' was removed, moved or replaced while it was recorded", file_.string()));
}

std::uint16_t McapWriter::add(McapSchema schema) {
  schema.id = static_cast<std::uint16_t>(schemas_.size() + 1);  // 0 stands for none
  Bytes& record = schemas_.emplace_back();
  append_record(record, Op::schema, schema.id, schema.name, schema.encoding, schema.data);
  append(chunk_.records, record);
  return schema.id;
}

std::uint16_t McapWriter::add(McapChannel channel) {
  channel.id = static_cast<std::uint16_t>(channels_.size());
  Bytes& record = channels_.emplace_back();
  append_record(record, Op::channel, channel.id, channel.schema_id, channel.topic,
                channel.message_encoding, channel.metadata);
  append(chunk_.records, record);
  counts_[channel.id] = 0;
  return channel.id;
}

void McapWriter::write(std::uint16_t channel, std::uint32_t sequence, Time log_time,
                       Time publish_time, std::span<const std::byte> data) {
  auto& index = chunk_.index[channel];
  const bool is_first = chunk_.index.size() == 1 && index.empty();
  chunk_.first = is_first ? log_time : std::min(chunk_.first, log_time);
  chunk_.last = is_first ? log_time : std::max(chunk_.last, log_time);
  first_ = messages_ == 0 ? log_time : std::min(first_, log_time);
  last_ = messages_ == 0 ? log_time : std::max(last_, log_time);
  index.push_back({log_time.ns, chunk_.records.size()});
  append_record(chunk_.records, Op::message, channel, sequence, log_time, publish_time, data);
  ++messages_;
  ++counts_[channel];
  if (chunk_.records.size() >= options_.chunk_bytes) end_chunk();
}

void McapWriter::end_chunk() {
  check_file();
  if (chunk_.records.empty()) return;
  const Bytes* records = &chunk_.records;
  std::string_view compression;
  if (options_.compress) {
    zstd_->pack(chunk_.records, packed_);
    if (packed_.size() < chunk_.records.size()) {
      records = &packed_;
      compression = "zstd";
    }
  }
  Bytes bytes;
  bytes.reserve(records->size() + 64);
  const std::uint64_t unpacked = chunk_.records.size(), packed = records->size();
  append_record(bytes, Op::chunk, chunk_.first, chunk_.last, unpacked, crc_of(chunk_.records),
                compression, packed, *records);
  const std::uint64_t chunk_start = position_, chunk_length = bytes.size();

  Bytes places;  // of the message indexes, by channel
  for (const auto& [channel, entries] : chunk_.index) {
    append_all(places, channel, chunk_start + bytes.size());
    Bytes instants;
    for (const auto& [time, offset] : entries) append_all(instants, time, offset);
    append_record(bytes, Op::message_index, channel, Counted{instants});
  }
  const std::uint64_t index_length = bytes.size() - chunk_length;
  put_hashed(bytes);
  messages_in_file_ = messages_;
  put_link();

  append_record(chunk_indexes_.emplace_back(), Op::chunk_index, chunk_.first, chunk_.last,
                chunk_start, chunk_length, Counted{places}, index_length, compression, packed,
                unpacked);
  chunk_.records.clear();
  chunk_.index.clear();
}

void McapWriter::attach(const McapAttachment& attachment) {
  end_chunk();
  const std::uint64_t size = attachment.data.size();
  Bytes fields, bytes;
  append_all(fields, attachment.log_time, attachment.create_time, attachment.name,
             attachment.media_type, size, std::as_bytes(std::span{attachment.data}));
  append_record(bytes, Op::attachment, fields, crc_of(fields));
  const std::uint64_t start = position_;
  put_hashed(bytes);
  put_link();
  append_record(attachment_indexes_.emplace_back(), Op::attachment_index, start,
                std::uint64_t{bytes.size()}, attachment.log_time, attachment.create_time, size,
                attachment.name, attachment.media_type);
}

void McapWriter::add(const McapMetadata& metadata) {
  end_chunk();
  Bytes bytes;
  append_record(bytes, Op::metadata, metadata.name, metadata.values);
  const std::uint64_t start = position_;
  put_hashed(bytes);
  put_link();
  append_record(metadata_indexes_.emplace_back(), Op::metadata_index, start,
                std::uint64_t{bytes.size()}, metadata.name);
}

void McapWriter::close() {
  end_chunk();
  Bytes bytes;
  append_record(bytes, Op::data_end, crc_);
  put_hashed(bytes);
  put_summary();
  check_file();
  const bool synced = fsync(descriptor_) == 0 || errno == EINVAL || errno == EROFS;  // a pipe
  if (!synced || ::close(std::exchange(descriptor_, -1)) != 0) {
    throw std::runtime_error(fmt::format("cannot write '{}': {}", file_.string(),
                                         std::generic_category().message(errno)));
  }
}

void McapWriter::put_group(Op op, const std::vector<Bytes>& records, Bytes& summary, Bytes& offsets,
                           std::uint64_t start) const {
  if (records.empty()) return;
  const std::uint64_t group_start = start + summary.size();
  for (const Bytes& record : records) append(summary, record);
  append_record(offsets, Op::summary_offset, static_cast<std::uint8_t>(op), group_start,
                start + summary.size() - group_start);
}

void McapWriter::put_summary() {
  Bytes counts, statistics;
  for (const auto& [channel, count] : counts_) append_all(counts, channel, count);
  append_record(statistics, Op::statistics, messages_, static_cast<std::uint16_t>(schemas_.size()),
                count_of(channels_), count_of(attachment_indexes_), count_of(metadata_indexes_),
                count_of(chunk_indexes_), first_, last_, Counted{counts});

  const std::uint64_t start = position_;
  Bytes summary, offsets;
  put_group(Op::schema, schemas_, summary, offsets, start);
  put_group(Op::channel, channels_, summary, offsets, start);
  put_group(Op::statistics, {statistics}, summary, offsets, start);
  put_group(Op::chunk_index, chunk_indexes_, summary, offsets, start);
  put_group(Op::attachment_index, attachment_indexes_, summary, offsets, start);
  put_group(Op::metadata_index, metadata_indexes_, summary, offsets, start);
  if (chain_) {  // the last link is of the summary; what follows says only where things stand
    chain_->add(summary);
    head_ = chain_->end_link();
    append(summary, ChainRecord{.number = ++links_, .hash = head_}.bytes());
  }
  const std::uint64_t offsets_start = start + summary.size();
  append(summary, offsets);
  // Its CRC is of all before it, with the length that the footer will have.
  append_record(summary, Op::footer, start, offsets_start, std::uint32_t{0});
  summary.resize(summary.size() - 4);
  append(summary, crc_of(summary));
  append(summary, std::as_bytes(std::span{mcap::kMagic}));
  put(summary);
}

}  // namespace armature
