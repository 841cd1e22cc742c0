// SPDX-License-Identifier: Apache-2.0
// The other process of the tests:
//   fast_dds_peer DOMAIN DEPLOYMENT FINGERPRINT
//   echo|talk|talk_text|talk_other_layout|latched_reader|pictures
// echo sends what comes on rt/test/to_peer back on rt/test/from_peer; talk_* write on
// rt/test/from_peer until the process is ended or its standard input closes. pictures writes a pair
// of them on rt/test/left and rt/test/right 30 times a second, numbered in `step`, and 200 commands
// a second on rt/test/from_peer, without shared memory.
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "armature/bus/fast_dds/fast_dds_transport.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/std_msgs.hpp"

namespace {

using namespace armature;  // NOLINT: a test program

Time system_now() {
  return Time{
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch())
          .count()};
}

bool input_closed(int timeout_ms) {
  pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
  char byte = 0;
  return poll(&input, 1, timeout_ms) > 0 && read(STDIN_FILENO, &byte, 1) <= 0;
}

void talk(Transport& transport, const MessageType& type) {
  SamplePool pool{type, 16};  // outlives the writer, which may still be sending
  const TopicSpec topic{"rt/test/from_peer", &type, QosProfile::command};
  const auto writer = transport.advertise(topic).value();
  while (!input_closed(10)) {
    SampleRef sample = pool.loan();
    sample.mutable_info().published = system_now();
    writer->offer(sample);
  }
}

void pictures(Transport& transport) {
  const MessageType& command_type = message_type<msg::JointState>();
  const MessageType& picture_type = message_type<msg::Image>();
  SamplePool command_pool{command_type, 64}, picture_pool{picture_type, 16};
  const auto command =
      transport.advertise({"rt/test/from_peer", &command_type, QosProfile::command}).value();
  std::vector<std::unique_ptr<RemoteWriter>> eyes;
  for (const char* topic : {"rt/test/left", "rt/test/right"}) {
    eyes.push_back(transport.advertise({topic, &picture_type, QosProfile::sensor}).value());
  }
  constexpr std::chrono::milliseconds kTick{5};
  constexpr int kTicksOfAPicture = 7;
  auto next = std::chrono::steady_clock::now();
  for (std::uint32_t tick = 0; !input_closed(0); ++tick) {
    std::this_thread::sleep_until(next += kTick);
    SampleRef now = command_pool.loan();
    now.mutable_info().published = system_now();
    command->offer(now);
    if (tick % kTicksOfAPicture != 0) continue;
    for (const auto& eye : eyes) {
      SampleRef picture = picture_pool.loan();
      auto& image = *static_cast<msg::Image*>(picture.mutable_message());
      image.data_().resize(std::size_t{1280} * 720);
      image.step_() = tick / kTicksOfAPicture;
      picture.mutable_info().published = system_now();
      eye->offer(picture);
    }
  }
}

void echo(Transport& transport) {
  const MessageType& type = message_type<msg::JointState>();
  const auto writer = transport.advertise({"rt/test/from_peer", &type, QosProfile::state}).value();
  const auto reader = transport
                          .subscribe({"rt/test/to_peer", &type, QosProfile::state}, false,
                                     [&](const SampleRef& sample) { writer->offer(sample); })
                          .value();
  while (!input_closed(1000)) {
  }
}

void latched_reader(Transport& transport) {
  const auto reader =
      transport
          .subscribe({"rt/test/to_peer", &message_type<msg::JointState>(), QosProfile::latched},
                     false, [](const SampleRef&) {})
          .value();
  while (!input_closed(1000)) {
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  TransportOptions options;
  options.network.domain = std::atoi(argv[1]);
  options.deployment = argv[2];
  options.fingerprint = argv[3];
  options.now = system_now;
  const std::string task = argv[4];
  options.network.shared_memory = task != "pictures";
  const auto transport = FastDdsTransport::make(options);
  if (!transport) {
    std::cerr << transport.error().text << "\n";
    return 1;
  }
  if (task == "talk") talk(**transport, message_type<msg::JointState>());
  if (task == "talk_text") talk(**transport, message_type<msg::String>());
  if (task == "talk_other_layout") {
    MessageType changed = message_type<msg::JointState>();
    ++changed.layout;
    talk(**transport, changed);
  }
  if (task == "echo") echo(**transport);
  if (task == "pictures") pictures(**transport);
  if (task == "latched_reader") latched_reader(**transport);
  return 0;
}
