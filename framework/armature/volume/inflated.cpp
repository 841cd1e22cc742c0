// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/inflated.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <memory>

namespace armature {

namespace {

/// What a byte of deflate's becomes at most: two bits stand for 258 bytes.
constexpr std::size_t kMostPerByte = 1032;

/// Gives zlib the next piece of `left` when it has used up the one before.
void feed(uInt& available, std::size_t& left, std::size_t piece_bytes) {
  if (available > 0) return;
  available = static_cast<uInt>(std::min(left, piece_bytes));
  left -= available;
}

}  // namespace

Expected<std::string> inflated(std::string_view gzip, std::size_t max_bytes,
                               std::size_t piece_bytes) {
  constexpr int kGzip = 16;  // what zlib adds to its window's bits for gzip's header
  z_stream stream{};
  if (inflateInit2(&stream, MAX_WBITS + kGzip) != Z_OK) return refuse("zlib cannot begin");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end{&stream, inflateEnd};
  // No more than the data can hold, whatever is claimed of them.
  const std::size_t room = std::min(max_bytes, kMostPerByte * gzip.size());
  std::string bytes(room, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(gzip.data()));
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  std::size_t unread = gzip.size(), unwritten = room;
  int status = Z_OK;
  while (status == Z_OK) {
    feed(stream.avail_in, unread, piece_bytes);
    feed(stream.avail_out, unwritten, piece_bytes);
    status = inflate(&stream, Z_NO_FLUSH);
  }
  const std::size_t written = room - unwritten - stream.avail_out;
  // Nothing is left of the input, or no room.
  const bool is_stuck = status == Z_BUF_ERROR;
  if (status != Z_STREAM_END && !is_stuck) {
    return refuse(fmt::format("its gzip data are damaged after {} bytes: {}", written,
                              stream.msg ? stream.msg : zError(status)));
  }
  if (is_stuck && written < max_bytes) {
    return refuse(fmt::format(
        "its gzip data end within the stream, after {} bytes: is it truncated?", written));
  }
  bytes.resize(written);
  return bytes;
}

}  // namespace armature
