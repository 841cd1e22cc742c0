// SPDX-License-Identifier: Apache-2.0
#include "armature/recording/mapped_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace armature {
namespace {

/// What the handler of SIGBUS may look at: a file that is mapped.
struct MappedPlace {
  std::atomic<const std::byte*> begin = nullptr;  // set last, cleared first
  const std::byte* end = nullptr;
  std::array<char, 512> name{};
};
std::array<MappedPlace, 64> places;  // a file that finds none is not told by name

struct sigaction before_this {};  // what became of SIGBUS

void say(std::string_view text) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
}

void tell_shortened_file(int signal, siginfo_t* info, void*) {
  const auto* at = static_cast<const std::byte*>(info->si_addr);
  for (const MappedPlace& place : places) {
    const std::byte* begin = place.begin.load();
    if (!begin || at < begin || at >= place.end) continue;
    say("armature: '");
    say(place.name.data());
    say("' was made shorter while it was read, or cannot be read any more\n");
    _exit(1);
  }
  // The access is made again, and is another one's.
  sigaction(signal, &before_this, nullptr);
  if (info->si_code <= 0) raise(signal);  // it was no access
}

void handle_shortened_files() {
  struct sigaction now {};
  if (sigaction(SIGBUS, nullptr, &now) != 0) return;
  if ((now.sa_flags & SA_SIGINFO) != 0 && now.sa_sigaction == &tell_shortened_file) return;
  before_this = now;
  struct sigaction handler {};
  handler.sa_sigaction = &tell_shortened_file;
  handler.sa_flags = SA_SIGINFO | SA_ONSTACK;
  sigaction(SIGBUS, &handler, nullptr);
}

std::size_t take_place(std::span<const std::byte> bytes, const std::string& name) {
  static std::mutex mutex;
  const std::lock_guard lock{mutex};
  handle_shortened_files();
  const auto free = std::ranges::find_if(places, [](const auto& place) { return !place.begin; });
  if (free == places.end()) return places.size();
  free->name.fill(0);
  std::memcpy(free->name.data(), name.data(), std::min(name.size(), free->name.size() - 1));
  free->end = bytes.data() + bytes.size();
  free->begin = bytes.data();
  return static_cast<std::size_t>(free - places.begin());
}

}  // namespace

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
  place_ = bytes_.empty() ? places.size() : take_place(bytes_, file.string());
}

MappedFile::~MappedFile() {
  if (place_ < places.size()) places[place_].begin = nullptr;
  if (!bytes_.empty()) munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

}  // namespace armature
