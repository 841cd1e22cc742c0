// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "command.hpp"

namespace armature::test {

/// Two machines with a cable between them, as far as DDS can tell: network namespaces, each with
/// a loopback interface and shared memory of its own. The desk has been on for 5000 s longer. They
/// are gone with this object. With `faults`, options of cable_relay, the cable has those.
class TwoHosts {
 public:
  static constexpr const char* kInterface = "eth0";  // of both, at the cable

  struct Host {
    std::string address;
    std::unique_ptr<Command> holder{};  // sleeps in the namespaces of the host

    /// The process that holds the namespaces.
    pid_t pid() const;
    /// The command that runs `words` there.
    std::vector<std::string> command(std::vector<std::string> words) const;
  };

  explicit TwoHosts(const std::vector<std::string>& faults = {});
  /// Why there are none here, or "".
  const std::string& missing() const { return missing_; }
  const Host& robot() const { return robot_; }
  const Host& desk() const { return desk_; }
  /// How many frames the cable let through that have the text it was told to count. It ends there.
  int counted();

 private:
  std::string make(const std::vector<std::string>& faults);
  std::string connect(const std::vector<std::string>& faults);

  Host robot_{.address = "10.77.0.1"};
  Host desk_{.address = "10.77.0.2"};
  Host between_{.address = ""};
  std::unique_ptr<Command> cable_;  // one with faults
  std::string missing_;
};

}  // namespace armature::test
