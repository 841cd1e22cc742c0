// SPDX-License-Identifier: Apache-2.0
#include "bench/loop/measured_loop.hpp"

#include <fmt/format.h>
#include <time.h>

#include <utility>

#include "armature/config/document.hpp"
#include "armature/runtime/execution/real_time_thread.hpp"

namespace armature::bench {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kSecond_ns + now.tv_nsec;
}

void sleep_until(std::int64_t ns) {
  const timespec at{.tv_sec = ns / kSecond_ns, .tv_nsec = ns % kSecond_ns};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) != 0) {
  }
}

DeploymentConfig read(const LoopSettings& settings, const PluginRegistry& plugins) {
  const std::string text = fmt::format(
      "armature: 1\n"
      "name: bench_loop\n"
      "executors: {{control: {{period_s: {:g}, priority: {}, lock_memory: true}}}}\n"
      "components: {{loop: {{plugin: bench/loop, executor: control}}}}\n"
      "{}",
      settings.period_s, settings.priority,
      settings.recording.empty() ? "" : "record: {file: \"" + settings.recording + "\"}\n");
  config::Problems problems;
  DeploymentConfig config =
      read_deployment(config::parse_text(text, "bench loop"), plugins, problems);
  problems.throw_if_any();
  return config;
}

/// Runs until it is told to end.
class UntilEnd final : public RunWatch {
 public:
  explicit UntilEnd(const std::atomic<bool>& end) : end_{end} {}
  std::optional<std::string> stop_cause() override {
    if (!end_) return std::nullopt;
    return "all is measured";
  }

 private:
  const std::atomic<bool>& end_;
};

}  // namespace

Twin::Twin(const LoopSettings& settings) : settings_{settings}, thread_{[this] { loop(); }} {}

Twin::~Twin() {
  end_ = true;
  thread_.join();
}

void Twin::loop() {
  prepare_thread({.name = "twin", .priority = settings_.priority, .cpu = {}, .has_period = true});
  msg::JointState state;
  const auto period_ns = static_cast<std::int64_t>(settings_.period_s * 1e9);
  std::int64_t release = now_ns();
  for (std::uint64_t step = 0; !end_; ++step) {
    sleep_until(release);
    const std::int64_t now = now_ns();
    lateness_.add(Duration{now - release});
    requests_.answer();
    tiny_work(step, state);
    release += period_ns * ((now - release) / period_ns + 1);
  }
}

OurLoop::OurLoop(const LoopSettings& settings, std::function<void(const std::string&)> note) {
  plugins_.add<LoopComponent>(LoopComponent::kPlugin);
  deployment_ =
      std::make_unique<Deployment>(read(settings, plugins_), plugins_,
                                   Deployment::Options{.on_line = {}, .on_note = std::move(note)});
  for (const auto& runner : deployment_->runners()) {
    if (runner->name() != "loop") continue;
    runner_ = runner.get();
    component_ = &dynamic_cast<LoopComponent&>(runner->component());
  }
  deployment_->connect(plugins_, settings.domain);
  if (!settings.recording.empty()) deployment_->record(settings.recording, nullptr);
  thread_ = std::thread{[this] {
    UntilEnd until_end{end_};
    deployment_->run(until_end);
  }};
}

OurLoop::~OurLoop() {
  end_ = true;
  if (thread_.joinable()) thread_.join();
  deployment_->end_recording();
}

int OurLoop::readers() const {
  const RemoteWriter* remote = runner_->outputs().front().topic().remote();
  return remote ? remote->matched_readers() : 0;
}

}  // namespace armature::bench
