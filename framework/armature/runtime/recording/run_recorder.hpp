// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/recording/mcap_queue.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/execution/component_runner.hpp"
#include "armature/runtime/recording/activation_log.hpp"
#include "armature/runtime/recording/page_rate.hpp"

namespace armature ARMATURE_EXPORT {

/// Records one process of a run from inside: what its components publish, what they get from other
/// processes, and their activations, so that `armature replay` can repeat each call bit for bit.
/// Components never wait for it: they leave references to samples in a ring, and a thread of the
/// recorder encodes and writes them. On the simulated clock they wait, and nothing is lost.
class RunRecorder {
 public:
  struct Options {
    std::filesystem::path file;
    /// Only so long before and after each trouble; then `file_at` names the file of each.
    std::optional<Duration> around_faults = {};
    std::function<std::filesystem::path(Time)> file_at = {};
    /// "/dental_lamp/*" stands for all that begin so; empty: all. The recording counts as a reader
    /// of a topic that is named whole; where none is named, of all but compressed pictures.
    std::vector<std::string> topics;
    bool compress = true;
    bool thin = false;  // no activations, and of topics that come often not all messages
    msg::DeploymentDescription description;  // of the process
    /// Told once, on another thread, when nothing more can be written.
    std::function<void(const std::string&)> on_problem;
    /// Told of each file around a trouble, on another thread.
    std::function<void(const std::string&)> on_file = {};
  };
  using Runners = std::vector<std::unique_ptr<ComponentRunner>>;

  /// Before the run. `deployment`, `runners` and `clock` outlive it, and the topics of the runners
  /// do. Throws std::runtime_error when the file cannot be written.
  RunRecorder(Options options, const DeploymentConfig& deployment, const Runners& runners,
              const Clock& clock);
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  /// Something has gone wrong at `now`, by the deployment's clock. Any thread; real-time safe.
  void mark_trouble(Time now) { trouble_ns_.store(now.ns, std::memory_order_relaxed); }

  /// After the last call of a component: writes what waits and the `figures` of the run, if there
  /// are any, and ends the file. What became of it: "run.mcap: 61124 messages, 12000 activations,
  /// 69.1 MB, last hash 5d1c..", or nothing where each file was told. Throws std::runtime_error.
  std::string close(const std::optional<McapAttachment>& figures = {});

 private:
  /// A topic as a port sees it.
  struct Port {
    std::string topic;
    const MessageType* type;
    QosProfile qos;
    std::string from = {};     // the deployment's other processes that write what is read; or ""
    bool is_numbered = false;  // by its writer there
  };
  /// One that is recorded: its ring, and the call that is being taken from it.
  struct Component {
    Component(const std::string& name, std::size_t capacity, const Clock& clock, bool waits)
        : log{capacity, clock, waits} {
      call.component_(name);
    }
    ActivationLog log;
    msg::Activation call;
    std::vector<Port> inputs;
    bool is_of_runtime = false;  // no replay repeats it
  };
  /// The numbers of samples that have been written. Readers may be heard before the writer, so
  /// they come nearly in order.
  class Sequences {
   public:
    /// False when it was there.
    bool add(std::uint64_t sequence);

   private:
    std::uint64_t through_ = 0;  // all up to here, and
    std::set<std::uint64_t> ahead_;
  };
  /// The samples of one writer.
  struct Channel {
    std::string topic;
    const MessageType* type = nullptr;
    QosProfile qos = QosProfile::state;
    std::string from = {};
    bool is_numbered = false;
    bool is_kept = false;
    Thinning thinning{std::nullopt};
    std::optional<std::uint16_t> id = {};  // in the file, from its first sample on
    Sequences written = {};
  };
  struct Reader final : Subscriber {
    void deliver(const SampleRef&) override {}
  };

  /// By how much the deployment's clock is ahead of that of this host.
  Duration clock_ahead() const;
  static McapQueue queue_of(const Options& options, bool simulated);
  void add_end();
  void tell_problem(const std::string& problem);
  bool is_read(const std::string& topic, const MessageType& type) const;
  void add(ComponentRunner& runner, const ComponentConfig& config,
           const DeploymentConfig& deployment, const Clock& clock);
  Channel& add_channel(std::uint32_t writer, const Port& port);
  void run();
  void take_all();
  void take(Component& component, ActivationLog::Entry& entry);
  void keep(const SampleRef& sample, Time at, Channel& channel);
  void write(const msg::Activation& call, Time at);
  void end_thread();

  Options options_;
  const Clock& clock_;
  std::string other_host_;  // that this is; empty: the main one
  McapQueue queue_;
  std::uint16_t activations_ = 0;  // the channel
  std::uint64_t count_ = 0;        // of them
  std::uint64_t thinned_ = 0;      // messages
  std::vector<std::unique_ptr<Component>> components_;
  std::unordered_map<std::uint32_t, Channel> channels_;  // by writer
  Reader reader_;                                        // of topics that are named whole
  bool told_problem_ = false;
  static constexpr std::int64_t kNoTrouble = -1;
  std::atomic<std::int64_t> trouble_ns_{kNoTrouble};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace armature
