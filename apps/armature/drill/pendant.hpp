// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "armature/values/temporary_folder.hpp"
#include "drill/drilled_deployment.hpp"

namespace armature::drill {

/// An operator's buttons, which a drill adds to its deployment and presses: an operator/pendant for
/// every component that heeds one, with a named pipe for its device.
class Pendant {
 public:
  /// Throws std::system_error when there is no room for a pipe.
  explicit Pendant(const std::vector<HeedsPendant>& components);
  ~Pendant();
  Pendant(const Pendant&) = delete;
  Pendant& operator=(const Pendant&) = delete;

  /// --set: what adds it to the deployment.
  std::vector<std::string> settings() const;
  void hold(bool down) const;
  /// Presses the button and lets it go.
  void rearm() const;
  void unplug();

 private:
  struct Device {
    HeedsPendant component;
    std::filesystem::path path;
    int file;
  };
  void send(int button, bool down) const;

  TemporaryFolder folder_;
  std::vector<Device> devices_;
};

}  // namespace armature::drill
