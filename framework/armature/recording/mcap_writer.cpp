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
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include "armature/recording/file_lock.hpp"

namespace armature {
namespace {

using Bytes = std::vector<std::byte>;
using mcap::Op;

constexpr int kCompression = 1;  // of zstd: the fastest of its ordinary levels

static_assert(std::endian::native == std::endian::little, "as MCAP stores numbers");

void append_bytes(Bytes& bytes, std::span<const std::byte> more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

template <class Number>
void append(Bytes& bytes, Number number) {
  static_assert(std::is_integral_v<Number>);
  append_bytes(bytes, std::as_bytes(std::span{&number, 1}));
}

void append_text(Bytes& bytes, std::string_view text) {
  append(bytes, static_cast<std::uint32_t>(text.size()));
  append_bytes(bytes, std::as_bytes(std::span{text}));
}

void append_map(Bytes& bytes, const std::map<std::string, std::string>& map) {
  Bytes inside;
  for (const auto& [key, value] : map) {
    append_text(inside, key);
    append_text(inside, value);
  }
  append(bytes, static_cast<std::uint32_t>(inside.size()));
  append_bytes(bytes, inside);
}

/// The record's place for its length is filled in by end_record.
std::size_t begin_record(Bytes& bytes, Op op) {
  append(bytes, static_cast<std::uint8_t>(op));
  append(bytes, std::uint64_t{0});
  return bytes.size();
}

void end_record(Bytes& bytes, std::size_t begin) {
  const std::uint64_t size = bytes.size() - begin;
  std::memcpy(bytes.data() + begin - sizeof size, &size, sizeof size);
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
  append_bytes(bytes, std::as_bytes(std::span{mcap::kMagic}));
  const std::size_t begin = begin_record(bytes, Op::header);
  append_text(bytes, "ros2");
  append_text(bytes, options_.library);
  end_record(bytes, begin);
  put_hashed(bytes);
  put_link();
}

void McapWriter::create() {
  constexpr int kMostOfOneName = 10'000;
  const std::filesystem::path named = file_;
  const int if_there = options_.keeps_older ? O_EXCL : 0;
  for (int number = 2; number <= kMostOfOneName; ++number) {
    descriptor_ = open(file_.c_str(), O_WRONLY | O_CREAT | if_there | O_CLOEXEC, 0600);
    if (descriptor_ >= 0) return;
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
  const std::size_t begin = begin_record(record, Op::schema);
  append(record, schema.id);
  append_text(record, schema.name);
  append_text(record, schema.encoding);
  append_text(record, schema.data);
  end_record(record, begin);
  append_bytes(chunk_.records, record);
  return schema.id;
}

std::uint16_t McapWriter::add(McapChannel channel) {
  channel.id = static_cast<std::uint16_t>(channels_.size());
  Bytes& record = channels_.emplace_back();
  const std::size_t begin = begin_record(record, Op::channel);
  append(record, channel.id);
  append(record, channel.schema_id);
  append_text(record, channel.topic);
  append_text(record, channel.message_encoding);
  append_map(record, channel.metadata);
  end_record(record, begin);
  append_bytes(chunk_.records, record);
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
  const std::size_t begin = begin_record(chunk_.records, Op::message);
  append(chunk_.records, channel);
  append(chunk_.records, sequence);
  append(chunk_.records, log_time.ns);
  append(chunk_.records, publish_time.ns);
  append_bytes(chunk_.records, data);
  end_record(chunk_.records, begin);
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
  std::size_t begin = begin_record(bytes, Op::chunk);
  append(bytes, chunk_.first.ns);
  append(bytes, chunk_.last.ns);
  append(bytes, std::uint64_t{chunk_.records.size()});
  append(bytes, crc_of(chunk_.records));
  append_text(bytes, compression);
  append(bytes, std::uint64_t{records->size()});
  append_bytes(bytes, *records);
  end_record(bytes, begin);
  const std::uint64_t chunk_start = position_, chunk_length = bytes.size();

  Bytes places;  // of the message indexes, by channel
  for (const auto& [channel, entries] : chunk_.index) {
    append(places, channel);
    append(places, chunk_start + bytes.size());
    begin = begin_record(bytes, Op::message_index);
    append(bytes, channel);
    append(bytes, static_cast<std::uint32_t>(16 * entries.size()));
    for (const auto& [time, offset] : entries) {
      append(bytes, time);
      append(bytes, offset);
    }
    end_record(bytes, begin);
  }
  const std::uint64_t index_length = bytes.size() - chunk_length;
  put_hashed(bytes);
  messages_in_file_ = messages_;
  put_link();

  Bytes& index = chunk_indexes_.emplace_back();
  begin = begin_record(index, Op::chunk_index);
  append(index, chunk_.first.ns);
  append(index, chunk_.last.ns);
  append(index, chunk_start);
  append(index, chunk_length);
  append(index, static_cast<std::uint32_t>(places.size()));
  append_bytes(index, places);
  append(index, index_length);
  append_text(index, compression);
  append(index, std::uint64_t{records->size()});
  append(index, std::uint64_t{chunk_.records.size()});
  end_record(index, begin);
  chunk_.records.clear();
  chunk_.index.clear();
}

void McapWriter::attach(const McapAttachment& attachment) {
  end_chunk();
  Bytes bytes;
  std::size_t begin = begin_record(bytes, Op::attachment);
  append(bytes, attachment.log_time.ns);
  append(bytes, attachment.create_time.ns);
  append_text(bytes, attachment.name);
  append_text(bytes, attachment.media_type);
  append(bytes, std::uint64_t{attachment.data.size()});
  append_bytes(bytes, std::as_bytes(std::span{attachment.data}));
  append(bytes, crc_of(std::span{bytes}.subspan(begin)));
  end_record(bytes, begin);
  const std::uint64_t start = position_;
  put_hashed(bytes);
  put_link();

  Bytes& index = attachment_indexes_.emplace_back();
  begin = begin_record(index, Op::attachment_index);
  append(index, start);
  append(index, std::uint64_t{bytes.size()});
  append(index, attachment.log_time.ns);
  append(index, attachment.create_time.ns);
  append(index, std::uint64_t{attachment.data.size()});
  append_text(index, attachment.name);
  append_text(index, attachment.media_type);
  end_record(index, begin);
}

void McapWriter::add(const McapMetadata& metadata) {
  end_chunk();
  Bytes bytes;
  std::size_t begin = begin_record(bytes, Op::metadata);
  append_text(bytes, metadata.name);
  append_map(bytes, metadata.values);
  end_record(bytes, begin);
  const std::uint64_t start = position_;
  put_hashed(bytes);
  put_link();

  Bytes& index = metadata_indexes_.emplace_back();
  begin = begin_record(index, Op::metadata_index);
  append(index, start);
  append(index, std::uint64_t{bytes.size()});
  append_text(index, metadata.name);
  end_record(index, begin);
}

void McapWriter::close() {
  end_chunk();
  Bytes bytes;
  const std::size_t begin = begin_record(bytes, Op::data_end);
  append(bytes, crc_);
  end_record(bytes, begin);
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
  for (const Bytes& record : records) append_bytes(summary, record);
  const std::size_t begin = begin_record(offsets, Op::summary_offset);
  append(offsets, static_cast<std::uint8_t>(op));
  append(offsets, group_start);
  append(offsets, start + summary.size() - group_start);
  end_record(offsets, begin);
}

void McapWriter::put_summary() {
  Bytes statistics;
  std::size_t begin = begin_record(statistics, Op::statistics);
  append(statistics, messages_);
  append(statistics, static_cast<std::uint16_t>(schemas_.size()));
  append(statistics, static_cast<std::uint32_t>(channels_.size()));
  append(statistics, static_cast<std::uint32_t>(attachment_indexes_.size()));
  append(statistics, static_cast<std::uint32_t>(metadata_indexes_.size()));
  append(statistics, static_cast<std::uint32_t>(chunk_indexes_.size()));
  append(statistics, first_.ns);
  append(statistics, last_.ns);
  append(statistics, static_cast<std::uint32_t>(10 * counts_.size()));
  for (const auto& [channel, count] : counts_) {
    append(statistics, channel);
    append(statistics, count);
  }
  end_record(statistics, begin);

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
    append_bytes(summary, ChainRecord{.number = ++links_, .hash = head_}.bytes());
  }
  const std::uint64_t offsets_start = start + summary.size();
  append_bytes(summary, offsets);
  begin = begin_record(summary, Op::footer);
  append(summary, start);
  append(summary, offsets_start);
  // Its CRC is of all before it, with the length that the footer will have.
  append(summary, std::uint32_t{0});
  end_record(summary, begin);
  summary.resize(summary.size() - 4);
  append(summary, crc_of(summary));
  append_bytes(summary, std::as_bytes(std::span{mcap::kMagic}));
  put(summary);
}

}  // namespace armature
