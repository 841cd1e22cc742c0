// SPDX-License-Identifier: Apache-2.0
// A transport/fast_dds on which nobody ever meets anybody. In a folder of its own, which a test
// puts before the framework's with ARMATURE_PLUGIN_PATH: the first of an id wins. With
// DEAF_TRANSPORT_HANGS in the environment its end does not return.
#include <chrono>
#include <cstdlib>
#include <thread>

#include "armature/bus/transport.hpp"
#include "armature/runtime/plugins/abi.hpp"
#include "armature/runtime/plugins/plugin.hpp"

static const char manifest[] __attribute__((section(".armature.manifest"), used, retain)) =
    "armature_plugin: 1\nid: transport/fast_dds\nkind: transport\ndoc: Meets nobody.\n";

static const char abi[] __attribute__((section(".armature.abi"), used, retain)) = ARMATURE_ABI_TAG;

namespace armature {

class DeafWriter final : public RemoteWriter {
 public:
  void offer(const SampleRef&) override {}
  int matched_readers() const override { return 0; }
  int peers() const override { return 0; }
  std::uint64_t dropped() const override { return 0; }
  std::vector<Watcher> who_watches() const override { return {}; }
  bool acknowledged(Duration) override { return true; }
};

class DeafReader final : public RemoteReader {
 public:
  int writers() const override { return 0; }
  int peers() const override { return 0; }
  std::vector<RefusedSamples> refused() const override { return {}; }
};

class DeafTransport final : public Transport {
 public:
  ~DeafTransport() override {
    while (std::getenv("DEAF_TRANSPORT_HANGS"))
      std::this_thread::sleep_for(std::chrono::seconds{1});
  }
  static Expected<std::unique_ptr<Transport>> make(const TransportOptions&) {
    return std::make_unique<DeafTransport>();
  }
  Expected<std::unique_ptr<RemoteWriter>> advertise(const TopicSpec&) override {
    return std::make_unique<DeafWriter>();
  }
  Expected<std::unique_ptr<RemoteReader>> subscribe(const TopicSpec&, bool,
                                                    std::function<void(SampleRef)>) override {
    return std::make_unique<DeafReader>();
  }
};

}  // namespace armature

ARMATURE_PLUGIN(armature::DeafTransport);
