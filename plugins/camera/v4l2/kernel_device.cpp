// SPDX-License-Identifier: Apache-2.0
#include "kernel_device.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <ctime>

namespace armature::camera::v4l2 {

int KernelDevice::open(const std::string& path) {
  close();
  file_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  return file_ >= 0 ? 0 : errno;
}

void KernelDevice::close() {
  for (const Mapping& mapping : mappings_) munmap(mapping.start, mapping.length);
  mappings_.clear();
  if (file_ >= 0) ::close(file_);
  file_ = -1;
}

int KernelDevice::request(unsigned long number, void* argument) {
  while (ioctl(file_, number, argument) != 0) {
    if (errno != EINTR) return errno;
  }
  return 0;
}

std::span<const std::uint8_t> KernelDevice::map(std::size_t length, std::int64_t offset) {
  // Some drivers map for reading and writing only.
  void* start = mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, file_, offset);
  if (start == MAP_FAILED) return {};
  mappings_.push_back({start, length});
  return {static_cast<const std::uint8_t*>(start), length};
}

VideoDevice::Wake KernelDevice::wait(int stop_descriptor, Duration timeout) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const timespec limit{.tv_sec = timeout.count() / kSecond, .tv_nsec = timeout.count() % kSecond};
  std::array<pollfd, 2> files{{{.fd = file_, .events = POLLIN, .revents = 0},
                               {.fd = stop_descriptor, .events = POLLIN, .revents = 0}}};
  const int ready = ppoll(files.data(), files.size(), &limit, nullptr);
  if (ready > 0 && files[1].revents != 0) return Wake::stop;
  return ready > 0 ? Wake::frame : Wake::timeout;
}

Duration KernelDevice::monotonic_now() const {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::chrono::seconds{now.tv_sec} + std::chrono::nanoseconds{now.tv_nsec};
}

}  // namespace armature::camera::v4l2
