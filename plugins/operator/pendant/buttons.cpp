// SPDX-License-Identifier: Apache-2.0
#include "buttons.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/input.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace armature::operator_::pendant {
namespace {

constexpr int kMaxReads = 100;
constexpr int kGoesDown = 1, kGoesUp = 0;  // 2: it repeats by itself

const char* hint(int error) {
  switch (error) {
    case EACCES: return "; its user must be in the group 'input'";
    case ENOENT:
    case ENODEV: return "; is it plugged in?";
    default: return "";
  }
}

}  // namespace

std::string Buttons::update() {
  pressed_.reset();
  released_.reset();
  if (std::string why = open(); !why.empty()) return why;
  // A stick that moves all the time must not hide a button that was let go.
  for (int i = 0; i < kMaxReads; ++i) {
    std::array<input_event, 64> events{};
    const ssize_t size = ::read(file_, events.data(), sizeof events);
    if (size == 0) return give_up(ENODEV);
    if (size < 0) return errno == EAGAIN || errno == EINTR ? std::string{} : give_up(errno);
    const auto count = static_cast<std::size_t>(size) / sizeof(input_event);
    for (std::size_t k = 0; k < count; ++k) hear(events[k]);
  }
  return {};
}

void Buttons::hear(const input_event& event) {
  if (event.type == EV_SYN && event.code == SYN_DROPPED) {
    held_.reset();
    released_.set();
  }
  if (event.type != EV_KEY || event.code >= kCodes) return;
  if (event.value == kGoesUp) {
    held_.reset(event.code);
    released_.set(event.code);
  }
  if (event.value != kGoesDown) return;
  held_.set(event.code);
  pressed_.set(event.code);
}

std::string Buttons::open() {
  if (file_ >= 0) return {};
  file_ = ::open(device_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  return file_ >= 0 ? std::string{} : give_up(errno);
}

std::string Buttons::give_up(int error) {
  close();
  return fmt::format("cannot read {}: {}{}", device_, std::strerror(error), hint(error));
}

void Buttons::close() {
  if (file_ >= 0) ::close(file_);
  file_ = -1;
  held_.reset();
  pressed_.reset();
}

}  // namespace armature::operator_::pendant
