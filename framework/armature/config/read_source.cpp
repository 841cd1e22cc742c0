// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <optional>
#include <string>
#include <system_error>

#include "armature/config/problems.hpp"
#include "armature/config/source_text.hpp"

namespace armature::config {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::size_t kLargestFile = 16U << 20U;
constexpr std::chrono::seconds kTimeout{2};

/// How long pipes may still be waited for; nothing: each by itself.
thread_local std::optional<SteadyClock::duration> t_left;

/// An open file, and the place that asked for it.
class Source {
 public:
  Source(const std::filesystem::path& file, const Origin& asked_by)
      : file_{file}, asked_by_{asked_by} {
    // Opening a device may already do something.
    struct stat status {};
    if (stat(file.c_str(), &status) == 0) refuse_device(status.st_mode);
    descriptor_ = open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor_ < 0 || fstat(descriptor_, &status) != 0) fail(errno);
    refuse_device(status.st_mode);
    is_pipe_ = S_ISFIFO(status.st_mode);
  }
  ~Source() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  std::string read_all() const {
    std::string text;
    std::array<char, 1U << 16U> chunk;
    SteadyClock::duration own = kTimeout;
    for (auto& left = t_left ? *t_left : own;;) {
      if (is_pipe_) wait_at_most(left);
      const ssize_t count = read(descriptor_, chunk.data(), chunk.size());
      if (count == 0) return text;
      if (count < 0 && errno != EAGAIN && errno != EINTR) fail(errno);
      if (count > 0) text.append(chunk.data(), static_cast<std::size_t>(count));
      if (text.size() > kLargestFile) fail(EFBIG);
    }
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw ConfigError{
        {{asked_by_, fmt::format("cannot read '{}': {}{}", file_.string(), reason, hint())}}};
  }
  /// A value of a second `--set`, which takes one.
  std::string hint() const {
    const std::string file = file_.string();
    if (asked_by_.line != 0 || file.find('=') == std::string::npos) return "";
    return fmt::format("; is it a value? Write --set {}", file);
  }
  [[noreturn]] void fail(int error) const { fail(std::generic_category().message(error)); }

  void refuse_device(mode_t mode) const {
    if (S_ISCHR(mode) || S_ISBLK(mode)) fail("it is a device, not a file");
  }

  /// Returns when there is something to read, or the end; a pipe may have neither for ever. Takes
  /// from `left` what it took.
  void wait_at_most(SteadyClock::duration& left) const {
    const auto start = SteadyClock::now();
    const auto limit = std::chrono::ceil<std::chrono::milliseconds>(left);
    pollfd ready{.fd = descriptor_, .events = POLLIN, .revents = 0};
    const bool in_time = left.count() > 0 && poll(&ready, 1, static_cast<int>(limit.count())) != 0;
    left -= SteadyClock::now() - start;
    if (in_time) return;
    fail(fmt::format("it is a pipe that nobody has written to its end within {} s",
                     kTimeout.count()));
  }

  const std::filesystem::path& file_;
  const Origin& asked_by_;
  int descriptor_ = -1;
  bool is_pipe_ = false;
};

}  // namespace

PipeTimeLimit::PipeTimeLimit() : is_outermost_{!t_left} {
  if (is_outermost_) t_left = kTimeout;
}
PipeTimeLimit::~PipeTimeLimit() {
  if (is_outermost_) t_left.reset();
}

std::string read_source(const std::filesystem::path& file, const Origin& asked_by) {
  return Source{file, asked_by}.read_all();
}

}  // namespace armature::config
