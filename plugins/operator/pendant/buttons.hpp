// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <string>

struct input_event;

namespace armature::operator_::pendant {

/// The buttons of an input device of Linux (evdev). A button counts as held from the moment on when
/// it is seen to go down: one that was down already when the device was opened, or that may have
/// been let go unseen, is not held until it goes down again.
class Buttons {
 public:
  static constexpr int kCodes = 768;  // KEY_CNT

  explicit Buttons(std::string device) : device_{std::move(device)} {}
  ~Buttons() { close(); }
  Buttons(const Buttons&) = delete;
  Buttons& operator=(const Buttons&) = delete;

  /// Reads what has happened since the last call, and opens the device when it is not open. Empty,
  /// or why nothing can be read; then no button is held. Never waits for an event.
  std::string update();
  bool is_open() const { return file_ >= 0; }

  /// `code`: of the button, 0 to kCodes - 1. False, too, when it was let go since the update before
  /// and is down again.
  bool held(int code) const {
    const auto button = static_cast<std::size_t>(code);
    return held_[button] && !released_[button];
  }
  /// It went down since the update before.
  bool pressed(int code) const { return pressed_[static_cast<std::size_t>(code)]; }

 private:
  void hear(const input_event& event);
  std::string open();
  std::string give_up(int error);
  void close();

  std::string device_;
  int file_ = -1;
  std::bitset<kCodes> held_, pressed_, released_;
};

}  // namespace armature::operator_::pendant
