// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/inflated.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <memory>

namespace armature {

Expected<std::string> inflated(std::string_view gzip, std::size_t max_bytes) {
  constexpr int kGzip = 16;  // what zlib adds to its window's bits for gzip's header
  z_stream stream{};
  if (inflateInit2(&stream, MAX_WBITS + kGzip) != Z_OK) return refuse("zlib cannot begin");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end{&stream, inflateEnd};
  std::string bytes(max_bytes, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(gzip.data()));
  stream.avail_in = static_cast<uInt>(gzip.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  const int status = inflate(&stream, Z_FINISH);
  if (status == Z_DATA_ERROR || status == Z_NEED_DICT) {
    return refuse(fmt::format("its gzip data are damaged: {}", stream.msg ? stream.msg : "?"));
  }
  bytes.resize(max_bytes - stream.avail_out);
  return bytes;
}

}  // namespace armature
