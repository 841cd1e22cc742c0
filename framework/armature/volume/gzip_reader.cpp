// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/gzip_reader.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <stdexcept>

namespace armature {

struct GzipReader::State {
  z_stream stream{};
  std::array<char, 1U << 16U> packed;
  std::size_t unpacked = 0;  // [bytes]
  bool ended = false;
};

GzipReader::GzipReader(std::istream& in) : in_{in}, state_{std::make_unique<State>()} {
  constexpr int kGzip = 16;  // what zlib adds to its window's bits for gzip's header
  if (inflateInit2(&state_->stream, MAX_WBITS + kGzip) != Z_OK) {
    throw std::runtime_error("zlib cannot begin");
  }
}

GzipReader::~GzipReader() { inflateEnd(&state_->stream); }

Expected<std::size_t> GzipReader::read(std::span<char> bytes) {
  z_stream& stream = state_->stream;
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  while (stream.avail_out > 0 && !state_->ended) {
    if (stream.avail_in == 0) {
      in_.read(state_->packed.data(), static_cast<std::streamsize>(state_->packed.size()));
      stream.next_in = reinterpret_cast<Bytef*>(state_->packed.data());
      stream.avail_in = static_cast<uInt>(in_.gcount());
    }
    const int status = inflate(&stream, Z_NO_FLUSH);
    const std::size_t written = state_->unpacked + bytes.size() - stream.avail_out;
    if (status == Z_BUF_ERROR) {
      return refuse(fmt::format(
          "its gzip data end within the stream, after {} bytes: is it truncated?", written));
    }
    if (status != Z_OK && status != Z_STREAM_END) {
      return refuse(fmt::format("its gzip data are damaged after {} bytes: {}", written,
                                stream.msg ? stream.msg : zError(status)));
    }
    state_->ended = status == Z_STREAM_END;
  }
  const std::size_t count = bytes.size() - stream.avail_out;
  state_->unpacked += count;
  return count;
}

}  // namespace armature
