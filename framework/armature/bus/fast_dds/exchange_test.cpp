// SPDX-License-Identifier: Apache-2.0
// Samples cross from process to process, values and stamps equal; a process never gets its own
// back; nobody outside: nothing is encoded.
#include "armature/bus/fast_dds/fast_dds_test.hpp"
#include "armature/bus/fast_dds/observer.hpp"

namespace armature {
namespace {

using namespace std::chrono_literals;

TEST_F(FastDds, TwoProcessesExchangeSamples) {
  Peer peer{domain_, "lamp", "f00d", "echo"};
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  const Time before = system_now();
  ASSERT_TRUE(eventually([&] { return writer->matched_readers() == 1 && reader->writers() == 1; }));
  ASSERT_TRUE(eventually([&] {
    SampleRef numbered = sample(0.125);
    numbered.mutable_info().sequence = 5'000'000'007;
    writer->offer(numbered);
    return received() > 0;
  }));
  const std::scoped_lock lock{mutex_};
  EXPECT_EQ(received_[0].position_(), (std::vector<double>{0.125, -0.125}));
  EXPECT_EQ(received_[0].name_(), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(stamp_of(received_[0].header_().stamp_()).ns, 42);
  EXPECT_EQ(infos_[0].sequence, 5'000'000'007U) << "there and back, as the writer numbers it";
  // The echo keeps the time at which this process published; DDS rounds to 2^-32 s.
  EXPECT_GE(infos_[0].published.ns, before.ns - 1);
  EXPECT_LE(infos_[0].published, system_now());
  EXPECT_TRUE(events_.empty()) << events_.front().text;
}

TEST_F(FastDds, WhoOnlyWatchesIsNoPeer) {
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  Peer stranger{domain_, "lamp", "beef", "echo"};  // the same name, but started from another file
  ASSERT_TRUE(eventually([&] { return writer->matched_readers() == 1 && reader->writers() == 1; }));
  EXPECT_EQ(writer->peers(), 0);
  EXPECT_EQ(reader->peers(), 0);
  Peer peer{domain_, "lamp", "f00d", "echo"};
  EXPECT_TRUE(eventually([&] { return writer->peers() == 1 && reader->peers() == 1; }));
}

TEST_F(FastDds, OwnSamplesDoNotComeBack) {
  Peer peer{domain_, "lamp", "f00d", "echo"};
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  std::atomic<int> own{0};
  const auto own_reader =
      transport->subscribe(to_peer_, false, [&](const SampleRef&) { ++own; }).value();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  ASSERT_TRUE(eventually([&] {
    writer->offer(sample(1));
    return received() > 0;
  }));
  EXPECT_EQ(own, 0);
  EXPECT_EQ(own_reader->writers(), 0);
  EXPECT_EQ(writer->matched_readers(), 1);
}

TEST_F(FastDds, NothingIsEncodedWhileNobodyWatches) {
  static std::atomic<int> encoded{0};
  MessageType counting = type_;
  counting.encode_into = [](const void* message, std::span<std::byte> cdr) {
    ++encoded;
    return message_type<msg::JointState>().encode_into(message, cdr);
  };
  const auto transport = make_transport();
  const auto writer = transport->advertise({"rt/test/unwatched", &counting, QosProfile::state});
  const auto own = transport->subscribe({"rt/test/unwatched", &counting, QosProfile::state}, false,
                                        [](const SampleRef&) {});
  for (int i = 0; i < 100; ++i) (*writer)->offer(sample(i));
  EXPECT_EQ((*writer)->dropped(), 0U);
  EXPECT_EQ(encoded, 0);
}

TEST_F(FastDds, LatchedSamplesReachLateComers) {
  const auto transport = make_transport();
  const auto writer =
      transport->advertise({"rt/test/to_peer", &type_, QosProfile::latched}).value();
  writer->offer(sample(7));
  Peer peer{domain_, "lamp", "f00d", "latched_reader"};
  EXPECT_TRUE(eventually([&] { return writer->matched_readers() == 1; }));
  const auto observer = DdsObserver::make({.network = {.domain = domain_}}).value();
  std::atomic<int> seen{0};
  ASSERT_TRUE(
      observer->watch("/test/to_peer", seconds(30), [&](const ObservedSample&) { ++seen; }));
  EXPECT_TRUE(eventually([&] { return seen == 1; }));
}

TEST_F(FastDds, RepliesReachTheReaderThatIsDiscoveredAMomentAfterTheyWereWritten) {
  const auto solver = make_transport(), asker = make_transport();
  const TopicSpec reply{"rt/test/reply", &type_, QosProfile::reply};
  const auto writer = solver->advertise(reply).value();
  writer->offer(sample(1));
  writer->offer(sample(2));
  std::atomic<int> seen{0};
  const auto reader = asker->subscribe(reply, false, [&](const SampleRef&) { ++seen; });
  EXPECT_TRUE(eventually([&] { return seen == 2; }));
}

TEST_F(FastDds, MessagesLargerThanADatagramCross) {
  for (const char* folder : {"/dev/shm", "/proc"}) {
    SCOPED_TRACE(folder);
    const auto transport = make_transport({.folder = folder});
    const auto viewer = make_transport({.folder = folder});
    const MessageType& image_type = message_type<msg::Image>();
    SamplePool images{image_type, 2};
    const auto writer =
        transport->advertise({"rt/test/image", &image_type, QosProfile::sensor}).value();
    const auto observer = DdsObserver::make({.network = {.domain = domain_}}).value();
    std::atomic<std::size_t> bytes{0};
    std::atomic<std::uint64_t> number{0};
    const auto reader =
        viewer->subscribe({"rt/test/image", &image_type, QosProfile::sensor}, false,
                          [&](const SampleRef& seen) { number = seen.info().sequence; });
    ASSERT_TRUE(observer->watch("rt/test/image", seconds(30),
                                [&](const ObservedSample& seen) { bytes = seen.cdr.size(); }));
    ASSERT_TRUE(eventually([&] {
      SampleRef image = images.loan();
      static_cast<msg::Image*>(image.mutable_message())->data_().assign(1280 * 720, 200);
      image.mutable_info().published = system_now();
      image.mutable_info().sequence = 42;
      writer->offer(image);
      std::this_thread::sleep_for(30ms);
      return bytes > 0 && number > 0;
    }));
    EXPECT_GT(bytes, 1280U * 720U);
    EXPECT_EQ(number, 42U) << "it travels with the fragments, too";
  }
}

TEST_F(FastDds, ACommandThatIsTooOldWhenItArrivesIsNotHandedOver) {
  const auto tasks = make_transport(), arm = make_transport();
  const auto writer = tasks->advertise(command_).value();
  const auto reader = arm->subscribe(command_, true, collect()).value();
  ASSERT_TRUE(eventually([&] { return writer->peers() == 1 && reader->peers() == 1; }));
  SampleRef old = sample(1);
  old.mutable_info().published = system_now() - seconds(1);
  writer->offer(old);
  ASSERT_TRUE(eventually([&] {
    writer->offer(sample(2));
    std::this_thread::sleep_for(10ms);
    return received() > 0;
  }));
  const std::scoped_lock lock{mutex_};
  EXPECT_EQ(received_[0].position_()[0], 2);
}

TEST_F(FastDds, AStrangersSampleIsAsOldAsItsWayFromWhenItArrived) {
  Peer stranger{domain_, "other", "beef", "talk"};
  const auto transport = make_transport([] { return Time{} + seconds(77); });
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  ASSERT_TRUE(eventually([&] { return received() > 0; }));
  const std::scoped_lock lock{mutex_};
  EXPECT_EQ(infos_[0].published, Time{} + seconds(77)) << "by our clock, not by the stranger's";
}

}  // namespace
}  // namespace armature
