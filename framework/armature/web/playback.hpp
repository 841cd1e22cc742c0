// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// A recording that is played to its watchers, who may pause it, seek in it and change its speed.
/// There is one position for all of them. All functions are called by the thread that serves them.
class Playback {
 public:
  enum class Status : std::uint8_t { playing = 0, paused = 1, ended = 3 };  // 2: not used here
  struct State {
    Status status = Status::paused;
    Time at;          // by the clock of the recording
    float speed = 1;  // times as fast as it was
    bool operator==(const State&) const = default;
  };
  struct Request {
    bool plays = false;
    float speed = 1;  // one that is not above 0 changes nothing
    std::optional<Time> seek;
  };
  struct Advance {
    Duration next{0};     // until there is something to do
    bool jumped = false;  // it began again; the messages that were handed on are those of there
  };

  virtual ~Playback() = default;

  virtual Time first() const = 0;
  virtual Time last() const = 0;
  virtual State state() const = 0;
  /// True when the position has jumped. Then the newest messages before the new position have been
  /// handed on, so that watchers see what was so at that time.
  virtual bool request(const Request& request) = 0;
  /// Hands on what is due now.
  virtual Advance advance() = 0;
};

}  // namespace armature
