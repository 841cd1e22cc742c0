// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <linux/input.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "armature/values/temporary_folder.hpp"

namespace armature::test {

/// A named pipe in the place of an input device.
class EventPipe {
 public:
  EventPipe() { plug_in(); }
  ~EventPipe() { unplug(); }
  EventPipe(const EventPipe&) = delete;
  EventPipe& operator=(const EventPipe&) = delete;

  std::string path() const { return folder_ / "events"; }
  void plug_in() {
    if (mkfifo(path().c_str(), 0600) != 0) throw std::runtime_error("cannot make " + path());
    file_ = open(path().c_str(), O_RDWR | O_CLOEXEC);
  }
  void unplug() {
    if (file_ >= 0) close(file_);
    file_ = -1;
    std::filesystem::remove(path());
  }
  /// `value`: 1 goes down, 0 goes up, 2 repeats.
  void send(int type, int code, int value) {
    input_event event{};
    event.type = static_cast<decltype(event.type)>(type);
    event.code = static_cast<decltype(event.code)>(code);
    event.value = value;
    if (write(file_, &event, sizeof event) != sizeof event) throw std::runtime_error("short write");
  }
  void press(int button) { send(EV_KEY, button, 1); }
  void release(int button) { send(EV_KEY, button, 0); }

 private:
  const TemporaryFolder folder_;
  int file_ = -1;
};

}  // namespace armature::test
