// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <utility>

namespace armature {

/// What a component tells about itself, kept for the operator and for state messages. From any
/// thread.
class Voice {
 public:
  enum class State { ok, degraded, fault };
  struct Status {
    State state = State::ok;
    std::string reason;
  };
  using Sink = std::function<void(const std::string& component, const std::string& line)>;

  Voice(std::string component, Sink sink)
      : component_{std::move(component)}, sink_{std::move(sink)} {}

  void say(std::string text);
  void set(State state, std::string reason);
  Status status() const;

 private:
  std::string component_;
  Sink sink_;
  mutable std::mutex mutex_;
  std::string last_line_;
  Status status_;
};

}  // namespace armature
