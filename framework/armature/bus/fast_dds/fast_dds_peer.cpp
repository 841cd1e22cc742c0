// SPDX-License-Identifier: Apache-2.0
// The other process of the tests:
//   fast_dds_peer DOMAIN DEPLOYMENT FINGERPRINT
//   echo|talk|talk_text|talk_other_layout|latched_reader
// echo sends what comes on rt/test/to_peer back on rt/test/from_peer; talk_* write on
// rt/test/from_peer until the process is ended or its standard input closes.
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <string>
#include <thread>

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
  const auto transport = FastDdsTransport::make(options);
  if (!transport) {
    std::cerr << transport.error().text << "\n";
    return 1;
  }
  const std::string task = argv[4];
  if (task == "talk") talk(**transport, message_type<msg::JointState>());
  if (task == "talk_text") talk(**transport, message_type<msg::String>());
  if (task == "talk_other_layout") {
    MessageType changed = message_type<msg::JointState>();
    ++changed.layout;
    talk(**transport, changed);
  }
  if (task == "echo") echo(**transport);
  if (task == "latched_reader") latched_reader(**transport);
  return 0;
}
