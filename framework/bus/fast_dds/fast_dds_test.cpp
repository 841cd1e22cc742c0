// SPDX-License-Identifier: Apache-2.0
// Rules proved here, most of them with a second process:
//  1. samples cross from process to process, values and stamps equal, over shared memory and UDP
//  2. a process never gets its own samples back from DDS
//  3. commands of another deployment are refused; whatever cannot meet is reported by name
//  4. a killed process is noticed
//  5. nobody outside: nothing is encoded
//  6. the observer sees and reads what it has no code for
#include <dlfcn.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "armature/bus/fast_dds/fast_dds_transport.hpp"
#include "armature/bus/fast_dds/observer.hpp"
#include "armature/messages/cdr_to_json.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/runtime/plugin.hpp"
#include "tests/dds_domain.hpp"

namespace armature {
namespace {

using Kind = TransportEvent::Kind;
using namespace std::chrono_literals;

/// fast_dds_peer as a child; asked to end when the test is over.
class Peer {
 public:
  Peer(int domain, const std::string& deployment, const std::string& fingerprint,
       const std::string& task) {
    int pipe_ends[2];
    EXPECT_EQ(pipe2(pipe_ends, O_CLOEXEC), 0);
    input_ = pipe_ends[1];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, pipe_ends[0], STDIN_FILENO);
    std::vector<std::string> words{FAST_DDS_PEER, std::to_string(domain), deployment, fingerprint,
                                   task};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&pid_, FAST_DDS_PEER, &actions, nullptr, arguments.data(), environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    close(pipe_ends[0]);
  }
  ~Peer() {
    if (pid_ > 0) end();
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

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

Time system_now() {
  return Time{
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch())
          .count()};
}

/// Waits long (a loaded machine), returns as soon as it can.
bool eventually(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + 30s;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

class FastDds : public testing::Test {
 protected:
  std::unique_ptr<Transport> make_transport(
      const std::filesystem::path& shared_memory = "/dev/shm") {
    TransportOptions options;
    options.domain = domain_;
    options.deployment = "lamp";
    options.fingerprint = "f00d";
    options.now = system_now;
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

TEST_F(FastDds, TwoProcessesExchangeSamples) {
  Peer peer{domain_, "lamp", "f00d", "echo"};
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  const Time before = system_now();
  ASSERT_TRUE(eventually([&] { return writer->watchers() == 1 && reader->writers() == 1; }));
  ASSERT_TRUE(eventually([&] {
    writer->offer(sample(0.125));
    return received() > 0;
  }));
  const std::scoped_lock lock{mutex_};
  EXPECT_EQ(received_[0].position_(), (std::vector<double>{0.125, -0.125}));
  EXPECT_EQ(received_[0].name_(), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(stamp_of(received_[0].header_().stamp_()).ns, 42);
  EXPECT_EQ(infos_[0].sequence, 1U);
  // The echo keeps the time at which this process published; DDS rounds to 2^-32 s.
  EXPECT_GE(infos_[0].published.ns, before.ns - 1);
  EXPECT_LE(infos_[0].published, system_now());
  EXPECT_TRUE(events_.empty()) << events_.front().text;
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
  EXPECT_EQ(writer->watchers(), 1);
}

TEST_F(FastDds, NothingIsEncodedWhileNobodyWatches) {
  static std::atomic<int> encoded{0};
  MessageType counting = type_;
  counting.encode = [](const void* message, std::vector<std::byte>& cdr) {
    ++encoded;
    message_type<msg::JointState>().encode(message, cdr);
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
  EXPECT_TRUE(eventually([&] { return writer->watchers() == 1; }));
  const auto observer = DdsObserver::make(domain_).value();
  std::atomic<int> seen{0};
  ASSERT_TRUE(
      observer->watch("/test/to_peer", seconds(30), [&](const ObservedSample&) { ++seen; }));
  EXPECT_TRUE(eventually([&] { return seen == 1; }));
}

TEST_F(FastDds, CommandsOfTheSameDeploymentAreTaken) {
  Peer peer{domain_, "lamp", "f00d", "talk"};
  const auto transport = make_transport();
  const auto reader = transport->subscribe(command_, true, collect()).value();
  EXPECT_TRUE(eventually([&] { return received() > 3; }));
  EXPECT_EQ(events(Kind::foreign_writer), 0);
}

TEST_F(FastDds, CommandsOfAnotherDeploymentAreRefusedAndReported) {
  Peer stranger{domain_, "other", "beef", "talk"};
  const auto transport = make_transport();
  const auto reader = transport->subscribe(command_, true, collect()).value();
  EXPECT_EQ(event(Kind::foreign_writer),
            "a writer of deployment 'other' (configuration beef) was refused on "
            "'rt/test/from_peer': commands are taken only from deployment 'lamp' (configuration "
            "f00d)");
  // A writer that is known to send: one of the right deployment gets through, the other never.
  Peer friend_{domain_, "lamp", "f00d", "talk"};
  ASSERT_TRUE(eventually([&] { return received() > 0; }));
  friend_.kill_now();
  ASSERT_TRUE(eventually([&] { return reader->writers() == 1; }));
  const std::size_t before = received();
  std::this_thread::sleep_for(100ms);  // ten samples of the stranger
  EXPECT_EQ(received(), before);
  EXPECT_EQ(events(Kind::foreign_writer), 1);
}

TEST_F(FastDds, ASecondTypeOnATopicIsReported) {
  const auto transport = make_transport();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  Peer peer{domain_, "other", "beef", "talk_text"};
  EXPECT_EQ(event(Kind::type_conflict),
            "a writer of deployment 'other' uses the type std_msgs::msg::dds_::String_ on "
            "'rt/test/from_peer', our reader uses sensor_msgs::msg::dds_::JointState_: they never "
            "meet");
}

TEST_F(FastDds, ASecondTypeInTheSameProcessIsRefused) {
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  const auto second =
      transport->advertise({"rt/test/to_peer", &message_type<msg::Image>(), QosProfile::state});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().text,
            "topic 'rt/test/to_peer' is used with the type sensor_msgs::msg::dds_::JointState_ and "
            "with sensor_msgs::msg::dds_::Image_ in this process");
}

TEST_F(FastDds, AnotherLayoutUnderTheSameNameIsReportedAndNotDecoded) {
  const auto transport = make_transport();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  Peer peer{domain_, "lamp", "f00d", "talk_other_layout"};
  EXPECT_EQ(event(Kind::layout_conflict),
            "a writer of deployment 'lamp' has another layout of "
            "sensor_msgs::msg::dds_::JointState_ on 'rt/test/from_peer' than this process: build "
            "both from the same idl/");
  ASSERT_TRUE(eventually([&] { return reader->writers() == 1; }));
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(received(), 0U);
}

TEST_F(FastDds, QosThatCannotMeetIsReported) {
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  Peer peer{domain_, "other", "beef", "latched_reader"};
  EXPECT_EQ(event(Kind::qos_conflict),
            "a reader on 'rt/test/to_peer' asks for more than our writer's profile 'state' offers: "
            "durability (readers there: deployment 'other')");
}

TEST_F(FastDds, AKilledProcessIsNoticed) {
  Peer peer{domain_, "lamp", "f00d", "talk"};
  const auto transport = make_transport();
  const auto reader = transport->subscribe(command_, true, collect()).value();
  ASSERT_TRUE(eventually([&] { return received() > 0; }));
  EXPECT_EQ(events(Kind::peer_lost), 0);
  peer.kill_now();
  EXPECT_EQ(event(Kind::peer_lost),
            "the writer on 'rt/test/from_peer' of deployment 'lamp' fell silent: its process died "
            "or hangs");
  EXPECT_TRUE(eventually([&] { return reader->writers() == 0; }));
}

TEST_F(FastDds, AProcessThatEndsProperlyIsNotMissed) {
  Peer peer{domain_, "lamp", "f00d", "talk"};
  const auto transport = make_transport();
  const auto reader = transport->subscribe(command_, true, collect()).value();
  ASSERT_TRUE(eventually([&] { return received() > 0; }));
  EXPECT_EQ(peer.end(), 0);
  EXPECT_TRUE(eventually([&] { return reader->writers() == 0; }));
  EXPECT_EQ(events(Kind::peer_lost), 0);
}

TEST_F(FastDds, WithoutSharedMemoryTopicsGoOverUdp) {
  Peer peer{domain_, "lamp", "f00d", "echo"};
  const auto transport = make_transport("/proc");
  EXPECT_THAT(event(Kind::note),
              testing::StartsWith("no shared memory, topics go over UDP: /proc is not writable"));
  const auto writer = transport->advertise(to_peer_).value();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  ASSERT_TRUE(eventually([&] {
    writer->offer(sample(1));
    return received() > 0;
  }));
}

TEST_F(FastDds, MessagesLargerThanADatagramCross) {
  for (const char* folder : {"/dev/shm", "/proc"}) {
    SCOPED_TRACE(folder);
    const auto transport = make_transport(folder);
    const MessageType& image_type = message_type<msg::Image>();
    SamplePool images{image_type, 2};
    const auto writer =
        transport->advertise({"rt/test/image", &image_type, QosProfile::sensor}).value();
    const auto observer = DdsObserver::make(domain_).value();
    std::atomic<std::size_t> bytes{0};
    ASSERT_TRUE(observer->watch("rt/test/image", seconds(30),
                                [&](const ObservedSample& seen) { bytes = seen.cdr.size(); }));
    ASSERT_TRUE(eventually([&] {
      SampleRef image = images.loan();
      static_cast<msg::Image*>(image.mutable_message())->data_().assign(1280 * 720, 200);
      image.mutable_info().published = system_now();
      writer->offer(image);
      std::this_thread::sleep_for(30ms);
      return bytes > 0;
    }));
    EXPECT_GT(bytes, 1280U * 720U);
  }
}

TEST_F(FastDds, TheObserverReadsATopicByItsName) {
  const auto transport = make_transport();
  const auto writer = transport->advertise(to_peer_).value();
  const auto reader = transport->subscribe(from_peer_, false, collect()).value();
  const auto observer = DdsObserver::make(domain_).value();
  std::mutex mutex;
  std::string shown;
  ASSERT_TRUE(observer->watch("/test/to_peer", seconds(30), [&](const ObservedSample& seen) {
    const std::scoped_lock lock{mutex};
    shown = cdr_to_json(*describe_type(seen.type), seen.cdr)->at("position").dump();
  }));
  ASSERT_TRUE(eventually([&] {
    writer->offer(sample(2.5));
    const std::scoped_lock lock{mutex};
    return !shown.empty();
  }));
  EXPECT_EQ(shown, "[2.5,-2.5]");

  ASSERT_TRUE(eventually([&] { return observer->topics().size() == 2; }));
  const auto topics = observer->topics();
  EXPECT_EQ(topics[0].name, "rt/test/from_peer");
  EXPECT_EQ(topics[0].readers, 1);
  EXPECT_EQ(topics[0].writers, 0);
  EXPECT_EQ(topics[1].name, "rt/test/to_peer");
  EXPECT_EQ(topics[1].writers, 1);
  EXPECT_EQ(topics[1].types, std::vector<std::string>{"sensor_msgs::msg::dds_::JointState_"});
  EXPECT_EQ(topics[1].deployments, std::vector<std::string>{"lamp"});
}

TEST_F(FastDds, AnUnwrittenTopicIsRefusedByTheObserver) {
  const auto observer = DdsObserver::make(domain_).value();
  const auto watched = observer->watch("/none", seconds(0.1), [](const ObservedSample&) {});
  ASSERT_FALSE(watched);
  EXPECT_EQ(watched.error().text, "nobody writes 'rt/none'");
}

TEST_F(FastDds, ADomainOutOfRangeIsRefused) {
  domain_ = 233;
  TransportOptions options;
  options.domain = 233;
  const auto made = FastDdsTransport::make(options);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().text, "DDS domain 233 is not within 0 and 232");
}

TEST_F(FastDds, ThePluginLibraryUnloadsAfterUse) {
  for (int round = 0; round < 3; ++round) {
    void* library = dlopen(ARMATURE_PLUGIN_BUILD_DIR "/transport_fast_dds.so", RTLD_NOW);
    ASSERT_NE(library, nullptr) << dlerror();
    const auto* entry = static_cast<const PluginEntry*>(dlsym(library, "armature_plugin_entry"));
    ASSERT_NE(entry, nullptr);
    EXPECT_EQ(std::string{entry->kind}, "transport");
    {
      TransportOptions options;
      options.domain = domain_;
      const auto made = reinterpret_cast<Transport::Factory>(entry->factory)(options);
      ASSERT_TRUE(made) << made.error().text;
      EXPECT_TRUE((*made)->advertise(to_peer_));
    }
    dlclose(library);
  }
}

}  // namespace
}  // namespace armature
