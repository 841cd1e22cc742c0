// SPDX-License-Identifier: Apache-2.0
// For the tests of the transport: a transport whose events are kept, and a second process.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "armature/bus/fast_dds/fast_dds_transport.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/values/spawn_plan.hpp"
#include "tests/dds_domain.hpp"

namespace armature {

/// fast_dds_peer as a child; asked to end when the test is over. `within`: words before its own.
class Peer {
 public:
  Peer(int domain, const std::string& deployment, const std::string& fingerprint,
       const std::string& task, std::vector<std::string> within = {}) {
    int pipe_ends[2];
    EXPECT_EQ(pipe2(pipe_ends, O_CLOEXEC), 0);
    input_ = pipe_ends[1];
    SpawnPlan plan;
    plan.hand_over(pipe_ends[0], STDIN_FILENO);
    std::vector<std::string> words = std::move(within);
    for (const auto& word :
         {std::string{FAST_DDS_PEER}, std::to_string(domain), deployment, fingerprint, task}) {
      words.push_back(word);
    }
    EXPECT_EQ(plan.start(words.front(), words, pid_), 0);
    close(pipe_ends[0]);
  }
  ~Peer() {
    if (pid_ > 0) end();
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  pid_t pid() const { return pid_; }
  void kill_now() {
    kill(pid_, SIGKILL);
    end();
  }
  /// Its exit status, after it was asked to end.
  int end() {
    close(input_);
    input_ = -1;
    int status = -1;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return status;
  }

 private:
  pid_t pid_ = -1;
  int input_ = -1;
};

inline Time system_now() {
  return Time{
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch())
          .count()};
}

/// Waits long (a loaded machine), returns as soon as it can.
inline bool eventually(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{30};
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds{5});
  }
  return true;
}

class FastDds : public testing::Test {
 protected:
  using Kind = TransportEvent::Kind;

  std::unique_ptr<Transport> make_transport(const SharedMemory& shared_memory = {}) {
    return make_transport(system_now, shared_memory);
  }
  std::unique_ptr<Transport> make_transport(std::function<Time()> now,
                                            const SharedMemory& shared_memory = {}) {
    TransportOptions options;
    options.network.domain = domain_;
    options.deployment = "lamp";
    options.fingerprint = "f00d";
    options.now = std::move(now);
    options.on_event = [this](const TransportEvent& event) {
      const std::scoped_lock lock{mutex_};
      events_.push_back(event);
    };
    auto made = FastDdsTransport::make(options, shared_memory);
    EXPECT_TRUE(made) << made.error().text;
    return std::move(*made);
  }

  /// The text of the first event of that kind; waits for it.
  std::string event(Kind kind) {
    std::string text;
    eventually([&] {
      const std::scoped_lock lock{mutex_};
      for (const TransportEvent& event : events_) {
        if (event.kind == kind && text.empty()) text = event.text;
      }
      return !text.empty();
    });
    return text;
  }
  int events(Kind kind) {
    const std::scoped_lock lock{mutex_};
    return static_cast<int>(std::ranges::count(events_, kind, &TransportEvent::kind));
  }

  /// A reader that remembers what it got.
  std::function<void(SampleRef)> collect() {
    return [this](SampleRef sample) {
      const std::scoped_lock lock{mutex_};
      received_.push_back(*static_cast<const msg::JointState*>(sample.message()));
      infos_.push_back(sample.info());
    };
  }
  std::size_t received() {
    const std::scoped_lock lock{mutex_};
    return received_.size();
  }

  SampleRef sample(double value) {
    SampleRef made = pool_.loan();
    auto& js = *static_cast<msg::JointState*>(made.mutable_message());
    set_stamp(js.header_().stamp_(), Time{42});
    js.name_({"a", "b"});
    js.position_({value, -value});
    made.mutable_info().published = system_now();
    return made;
  }

  int domain_ = unique_dds_domain();
  const MessageType& type_ = message_type<msg::JointState>();
  TopicSpec to_peer_{"rt/test/to_peer", &type_, QosProfile::state};
  TopicSpec from_peer_{"rt/test/from_peer", &type_, QosProfile::state};
  TopicSpec command_{"rt/test/from_peer", &type_, QosProfile::command};
  SamplePool pool_{type_, 16};
  std::mutex mutex_;
  std::deque<TransportEvent> events_;
  std::vector<msg::JointState> received_;
  std::vector<SampleInfo> infos_;
};

}  // namespace armature
