// SPDX-License-Identifier: Apache-2.0
// A program of another vendor, which knows nothing of this project but idl/, reads what we publish.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "armature/bus/fast_dds/fast_dds_transport.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "tests/dds_domain.hpp"

namespace armature {
namespace {

void fill(msg::JointState& joints, int i) {
  set_stamp(joints.header_().stamp_(), Time{1'000'000'000 + i});
  joints.header_().frame_id_("base");
  joints.name_({"lift", "boom"});
  joints.position_({0.1 * i, -1.0 / 3.0});
  joints.velocity_({1e-9, 2.5});
}

/// What the listener prints of it.
std::string line_of(int i) {
  char line[200];
  std::snprintf(line, sizeof line, "1 %d base lift=%.17g/%.17g boom=%.17g/%.17g\n", i, 0.1 * i,
                1e-9, -1.0 / 3.0, 2.5);
  return line;
}

TEST(CycloneDds, ReadsOurJointStatesWithEqualValues) {
  const int domain = unique_dds_domain();
  constexpr int kSamples = 20;
  TransportOptions options;
  options.network.domain = domain;
  options.deployment = "lamp";
  options.now = [] {
    return Time{
        std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch())
            .count()};
  };
  const auto transport = FastDdsTransport::make(options);
  ASSERT_TRUE(transport) << transport.error().text;
  const MessageType& type = message_type<msg::JointState>();
  SamplePool pool{type, 8};  // outlives the writer, which may still be sending
  const auto writer =
      (*transport)->advertise({"rt/lamp/arm/measured_js", &type, QosProfile::state}).value();

  std::ostringstream command;
  command << CYCLONE_LISTENER << " " << domain << " rt/lamp/arm/measured_js " << kSamples << " 40";
  FILE* listener = popen(command.str().c_str(), "r");
  ASSERT_NE(listener, nullptr);

  // A reader of volatile samples sees them from the moment on at which both sides have matched, so
  // the first line tells where it came in.
  std::atomic<bool> stop{false};
  std::thread talker{[&] {
    for (int i = 0; !stop; ++i) {
      SampleRef sample = pool.loan();
      fill(*static_cast<msg::JointState*>(sample.mutable_message()), i);
      sample.mutable_info().published = options.now();
      sample.mutable_info().sequence = static_cast<std::uint64_t>(i) + 1;
      writer->offer(sample);
      std::this_thread::sleep_for(std::chrono::milliseconds{10});
    }
  }};
  std::vector<std::string> lines;
  char line[200];
  while (std::fgets(line, sizeof line, listener)) lines.emplace_back(line);
  stop = true;
  talker.join();
  EXPECT_EQ(pclose(listener), 0);

  ASSERT_EQ(lines.size(), static_cast<std::size_t>(kSamples));
  const int first = std::stoi(lines.front().substr(2));
  for (int i = 0; i < kSamples; ++i) {
    EXPECT_EQ(lines[static_cast<std::size_t>(i)], line_of(first + i));
  }
}

}  // namespace
}  // namespace armature
