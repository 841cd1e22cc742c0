// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include "armature/values/expected.hpp"

namespace armature {

/// Opens a file that has an end. Refuses a folder, and a device or a pipe, which may have none or
/// make wait for it. The reason does not name the file.
inline Expected<std::ifstream> open_regular(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (std::filesystem::is_directory(status)) return refuse("it is a folder");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return refuse("it is a device or a pipe, not a file");
  }
  std::ifstream stream{file, std::ios::binary};
  if (!stream) return refuse(std::strerror(errno));
  return stream;
}

/// The bytes of such a file. Refuses more than `max_bytes` before it reads them.
inline Expected<std::string> bytes_of_regular(const std::filesystem::path& file,
                                              std::size_t max_bytes) {
  auto stream = open_regular(file);
  if (!stream) return tl::unexpected{stream.error()};
  std::error_code unknown;
  const auto size = std::filesystem::file_size(file, unknown);
  if (!unknown && size > max_bytes) {
    return refuse(fmt::format("it has {} bytes; at most {} are read", size, max_bytes));
  }
  std::string bytes(unknown ? 0 : static_cast<std::size_t>(size), '\0');
  stream->read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (stream->bad()) return refuse(std::strerror(errno));
  bytes.resize(static_cast<std::size_t>(stream->gcount()));  // it may have become shorter
  return bytes;
}

}  // namespace armature
