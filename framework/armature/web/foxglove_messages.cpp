// SPDX-License-Identifier: Apache-2.0
#include "armature/web/foxglove_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace armature {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class FromServer : std::uint8_t { message_data = 1, time = 2, playback_state = 5 };
enum class FromClient : std::uint8_t { playback_control = 3 };
enum class Command : std::uint8_t { play = 0, pause = 1 };

constexpr std::size_t kLongestId = 1024;  // [byte]

template <class Number>
void put(Number number, std::vector<std::byte>& bytes) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof number);
  std::memcpy(bytes.data() + at, &number, sizeof number);
}

/// Takes a number from the front of `bytes`, which has room for it.
template <class Number>
Number take(std::string_view& bytes) {
  Number number{};
  std::memcpy(&number, bytes.data(), sizeof number);
  bytes.remove_prefix(sizeof number);
  return number;
}

}  // namespace

std::array<std::byte, 13> message_head(std::uint32_t subscription, Time time) {
  std::array<std::byte, 13> head{std::byte{static_cast<std::uint8_t>(FromServer::message_data)}};
  std::memcpy(head.data() + 1, &subscription, sizeof subscription);
  std::memcpy(head.data() + 1 + sizeof subscription, &time.ns, sizeof time.ns);
  return head;
}

std::vector<std::byte> time_message(Time time) {
  std::vector<std::byte> bytes;
  put(FromServer::time, bytes);
  put(time.ns, bytes);
  return bytes;
}

Expected<PlaybackControlRequest> read_playback_control(std::string_view message) {
  constexpr std::size_t kShortest = 1 + 1 + 4 + 1 + 8 + 4;
  if (message.size() < kShortest) {
    return refuse(fmt::format("a binary message of {} bytes is none for playback, which has {}",
                              message.size(), kShortest));
  }
  if (const auto opcode = take<FromClient>(message); opcode != FromClient::playback_control) {
    return refuse(fmt::format("a binary message with the opcode {} is not known here",
                              static_cast<int>(opcode)));
  }
  PlaybackControlRequest control;
  const auto command = take<Command>(message);
  if (command > Command::pause) {
    return refuse(
        fmt::format("a playback does not know the command {}, only 0 (play) and 1 (pause)",
                    static_cast<int>(command)));
  }
  control.request.plays = command == Command::play;
  control.request.speed = take<float>(message);
  const bool seeks = take<std::uint8_t>(message) != 0;
  const Time time{take<std::int64_t>(message)};
  if (seeks) control.request.seek = time;
  const auto size = take<std::uint32_t>(message);
  if (size > std::min(message.size(), kLongestId)) {
    return refuse(
        fmt::format("the number of a playback request says that it has {} bytes, and has "
                    "{} of at most {}",
                    size, message.size(), kLongestId));
  }
  control.id = message.substr(0, size);
  return control;
}

std::vector<std::byte> playback_state_message(const Playback::State& state, bool jumped,
                                              std::string_view request_id) {
  std::vector<std::byte> bytes;
  put(FromServer::playback_state, bytes);
  put(state.status, bytes);
  put(state.at.ns, bytes);
  put(state.speed, bytes);
  put(static_cast<std::uint8_t>(jumped ? 1 : 0), bytes);
  put(static_cast<std::uint32_t>(request_id.size()), bytes);
  const auto id = std::as_bytes(std::span{request_id});
  bytes.insert(bytes.end(), id.begin(), id.end());
  return bytes;
}

}  // namespace armature
