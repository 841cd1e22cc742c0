// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "armature/values/expected.hpp"
#include "armature/web/playback.hpp"

namespace armature ARMATURE_EXPORT {

// The binary messages of Foxglove's WebSocket protocol. Numbers are little-endian.
// Source: github.com/foxglove/ws-protocol, docs/spec.md; those of playback (foxglove.sdk.v1):
// github.com/foxglove/foxglove-sdk, rust/foxglove/src/protocol/common.

/// What stands before the CDR of a message: opcode 1, the subscription, the time [ns].
std::array<std::byte, 13> message_head(std::uint32_t subscription, Time time);
/// The time of the server's clock: opcode 2, the time [ns].
std::vector<std::byte> time_message(Time time);

/// What a client asks of a playback: opcode 3, 0 to play or 1 to pause, speed (float32), whether it
/// seeks, to which time [ns], length and text of its own number.
struct PlaybackControlRequest {
  Playback::Request request;
  std::string id;
};
/// Refuses what is too short, what has another opcode, an unknown command, and a number that is
/// longer than 1 kB.
Expected<PlaybackControlRequest> read_playback_control(std::string_view message);

/// How a playback is: opcode 5, status, time [ns], speed (float32), whether it has jumped, length
/// and text of the request's own number, which is empty when nobody asked.
std::vector<std::byte> playback_state_message(const Playback::State& state, bool jumped,
                                              std::string_view request_id);

}  // namespace armature
