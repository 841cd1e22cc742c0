// SPDX-License-Identifier: Apache-2.0
// Pictures between processes without shared memory: they arrive, also where the system keeps less
// than one of them for a reader; what is lost is counted; commands are not held up.
#include "armature/bus/fast_dds/fast_dds_test.hpp"
#include "armature/bus/fast_dds/observer.hpp"

namespace armature {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kUntouchedSystem = 212'992;  // [B] net.core.rmem_max of Debian
constexpr std::uint32_t kOneDatagram = 65'536;

/// What a reader of a topic got.
struct Got {
  std::uint32_t first = 0, last = 0, count = 0;  // by the writer's own numbers, in Image::step
  std::uint64_t lost = 0;                        // as it is counted

  std::uint32_t sent() const { return count == 0 ? 0 : last - first + 1; }
};

class Pictures : public FastDds {
 protected:
  /// One process of the deployment, without shared memory.
  std::unique_ptr<Transport> process(std::uint32_t receive_buffer) {
    TransportOptions options{.network = {.domain = domain_, .shared_memory = false},
                             .deployment = "lamp",
                             .fingerprint = "f00d"};
    return FastDdsTransport::make(options, SharedMemory{}, receive_buffer).value();
  }
  std::unique_ptr<RemoteReader> read(Transport& transport, const char* topic,
                                     bool same_deployment_only, Got& got, Duration step = {}) {
    const TopicSpec spec{topic, &message_type<msg::Image>(), QosProfile::sensor};
    return transport
        .subscribe(spec, same_deployment_only,
                   [this, &got, step](const SampleRef& sample) {
                     {
                       const std::scoped_lock lock{mutex_};
                       const auto number =
                           static_cast<const msg::Image*>(sample.message())->step_();
                       if (got.count++ == 0) got.first = number;
                       got.last = number;
                       got.lost += sample.info().lost_before;
                     }
                     std::this_thread::sleep_for(step);
                   })
        .value();
  }
  /// What did not arrive is counted; a writer's process that is busy may have left one out itself.
  static void expect_all_accounted_for(const Got& got) {
    EXPECT_LE(got.count + got.lost, got.sent());
    EXPECT_GE(static_cast<double>(got.count + got.lost), 0.95 * got.sent());
  }
  Got now(const Got& got) {
    const std::scoped_lock lock{mutex_};
    return got;
  }
};

TEST_F(Pictures, BetweenProcessesOfADeploymentArriveWhereTheSystemKeepsLessThanOne) {
  Peer peer{domain_, "lamp", "f00d", "pictures"};
  const auto transport = process(kUntouchedSystem);
  Got left, right;
  const auto left_eye = read(*transport, "rt/test/left", true, left);
  const auto right_eye = read(*transport, "rt/test/right", true, right);
  ASSERT_TRUE(eventually([&] { return now(left).sent() >= 60 && now(right).sent() >= 60; }));
  for (const Got& got : {now(left), now(right)}) {
    EXPECT_GE(got.count, 0.9 * got.sent()) << "on a busy machine a few may be overwritten";
    expect_all_accounted_for(got);
  }
}

TEST_F(Pictures, ThatAreLostAreCountedOneByOne) {
  Peer peer{domain_, "lamp", "f00d", "pictures"};
  const auto transport = process(kOneDatagram);
  Got got;
  const auto best_effort = read(*transport, "rt/test/left", false, got);
  ASSERT_TRUE(eventually([&] { return now(got).sent() >= 30 && now(got).lost > 0; }));
  expect_all_accounted_for(now(got));
}

TEST_F(Pictures, ThatOneProcessIsSlowToTakeReachTheOthersInTime) {
  Peer peer{domain_, "lamp", "f00d", "pictures"};
  const auto slow = process(kReceiveBuffer), quick = process(kReceiveBuffer);
  Got late, in_time;
  const auto slow_reader = read(*slow, "rt/test/left", true, late, seconds(0.3));
  ASSERT_TRUE(eventually([&] { return now(late).count > 0; }));
  const auto quick_reader = read(*quick, "rt/test/left", true, in_time);
  ASSERT_TRUE(eventually([&] { return now(in_time).sent() >= 60; }));
  EXPECT_GE(now(in_time).count, 0.9 * now(in_time).sent());
  ASSERT_TRUE(eventually([&] { return now(late).lost > 0; }));
  expect_all_accounted_for(now(late));
}

TEST_F(Pictures, ThatAnOnlookerMissesAreCounted) {
  Peer peer{domain_, "lamp", "f00d", "pictures"};
  const auto observer =
      DdsObserver::make({.network = {.domain = domain_}, .asks_again = false}).value();
  std::atomic<std::uint64_t> lost{0};
  ASSERT_TRUE(observer->watch("/test/left", seconds(30), [&](const ObservedSample& sample) {
    lost += sample.lost_before;
    std::this_thread::sleep_for(100ms);  // three times too long
  }));
  EXPECT_TRUE(eventually([&] { return lost > 0; }));
}

TEST_F(Pictures, ThatTakeLongToSendHoldUpNoCommand) {
  static std::atomic<bool> is_sending{false}, may_end{false};
  MessageType slow = message_type<msg::Image>();
  slow.encode_into = [](const void* message, std::span<std::byte> cdr) {
    is_sending = true;
    while (!may_end) std::this_thread::sleep_for(1ms);
    return message_type<msg::Image>().encode_into(message, cdr);
  };
  const auto camera = make_transport(), arm = make_transport();
  SamplePool pool{slow, 1};
  const TopicSpec left{"rt/test/left", &slow, QosProfile::sensor};
  const auto picture = camera->advertise(left).value();
  const auto command = camera->advertise(command_).value();
  const auto eye = arm->subscribe(left, true, [](const SampleRef&) {}).value();
  const auto reader = arm->subscribe(command_, true, collect()).value();
  EXPECT_TRUE(eventually([&] { return picture->peers() == 1 && command->peers() == 1; }));
  picture->offer(pool.loan());
  EXPECT_TRUE(eventually([] { return is_sending.load(); }));
  EXPECT_TRUE(eventually([&] {
    command->offer(sample(1));
    std::this_thread::sleep_for(10ms);
    return received() > 0;
  })) << "while the picture is being sent";
  may_end = true;
}

TEST_F(Pictures, LoseNoCommandAndHoldNoneUp) {
  Peer peer{domain_, "lamp", "f00d", "pictures"};
  const auto transport = process(kReceiveBuffer);
  Got left, right;
  const auto left_eye = read(*transport, "rt/test/left", true, left);
  const auto right_eye = read(*transport, "rt/test/right", true, right);
  ASSERT_TRUE(eventually([&] { return now(left).count > 0 && now(right).count > 0; }));
  std::vector<Duration> delays;
  std::uint64_t lost = 0;
  const auto commands = transport
                            ->subscribe(command_, true,
                                        [&](const SampleRef& sample) {
                                          const std::scoped_lock lock{mutex_};
                                          lost += sample.info().lost_before;
                                          delays.push_back(system_now() - sample.info().published);
                                        })
                            .value();
  ASSERT_TRUE(eventually([&] {
    const std::scoped_lock lock{mutex_};
    return delays.size() >= 500;
  }));
  const std::scoped_lock lock{mutex_};
  EXPECT_EQ(lost, 0U);
  std::ranges::sort(delays);
  // A pair of pictures every 35 ms: half of the commands would wait for one that is sent slowly,
  // and one that lost its place in the receive buffer comes 20 ms later. A busy machine delays
  // some.
  EXPECT_LT(to_seconds(delays[delays.size() / 2]), 0.005);
}

}  // namespace
}  // namespace armature
