// SPDX-License-Identifier: Apache-2.0
#include "drill/pendant.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/input.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace armature::drill {
namespace {

constexpr int kHold = BTN_TRIGGER, kRearm = BTN_THUMB;

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

Pendant::Pendant(const std::vector<HeedsPendant>& components) {
  for (const HeedsPendant& component : components) {
    const auto path = folder_ / component.name;
    if (mkfifo(path.c_str(), 0600) != 0) fail("cannot make " + path.string());
    // For both: whoever opens a pipe for writing alone waits for its reader.
    const int file = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) fail("cannot open " + path.string());
    devices_.push_back({.component = component, .path = path, .file = file});
  }
}

Pendant::~Pendant() { unplug(); }

std::vector<std::string> Pendant::settings() const {
  std::vector<std::string> settings;
  for (const auto& [component, path, file] : devices_) {
    settings.push_back(fmt::format(
        "components.drill_pendant_{}={{plugin: operator/pendant, params: {{device: {}, "
        "hold_button: {}, rearm_button: {}}}, out: {{hold_to_run: {}, rearm: {}}}}}",
        component.name, path.string(), kHold, kRearm, component.hold_topic, component.rearm_topic));
  }
  return settings;
}

void Pendant::hold(bool down) const { send(kHold, down); }

void Pendant::rearm() const {
  send(kRearm, true);
  send(kRearm, false);
}

void Pendant::unplug() {
  for (Device& device : devices_) {
    std::error_code none;
    std::filesystem::remove(device.path, none);
    if (device.file >= 0) close(std::exchange(device.file, -1));
  }
}

void Pendant::send(int button, bool down) const {
  input_event event{};
  event.type = EV_KEY;
  event.code = static_cast<decltype(event.code)>(button);
  event.value = down ? 1 : 0;
  for (const Device& device : devices_) {
    if (device.file >= 0 && write(device.file, &event, sizeof event) < 0) fail("pendant");
  }
}

}  // namespace armature::drill
