// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/mapped_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace armature {

MappedFile::MappedFile(const std::filesystem::path& file) {
  const auto refuse = [&] {
    throw std::runtime_error(
        fmt::format("cannot read '{}': {}", file.string(), std::generic_category().message(errno)));
  };
  // A pipe would wait for its writer.
  const int descriptor = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) refuse();
  struct stat about {};
  if (fstat(descriptor, &about) != 0 || !S_ISREG(about.st_mode)) {
    close(descriptor);
    throw std::runtime_error(fmt::format("cannot read '{}': it is no regular file", file.string()));
  }
  const auto size = static_cast<std::size_t>(about.st_size);
  void* memory = size == 0 ? nullptr : mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  close(descriptor);
  if (memory == MAP_FAILED) refuse();
  bytes_ = {static_cast<const std::byte*>(memory), size};
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

}  // namespace armature
