// SPDX-License-Identifier: Apache-2.0
#include "bench/loop/measured_loop.hpp"

#include <fmt/format.h>
#include <time.h>

#include <utility>

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

std::string text_of(const LoopSettings& settings) {
  return fmt::format(
      "armature: 1\n"
      "name: bench_loop\n"
      "executors: {{control: {{period_s: {:g}, priority: {}, lock_memory: true}}}}\n"
      "components: {{loop: {{plugin: bench/loop, executor: control}}}}\n"
      "{}",
      settings.period_s, settings.priority,
      settings.recording.empty() ? "" : "record: {file: \"" + settings.recording + "\"}\n");
}

}  // namespace

Twin::Twin(const LoopSettings& settings) : settings_{settings}, thread_{[this] { loop(); }} {}

Twin::~Twin() {
  end_ = true;
  thread_.join();
}

void Twin::loop() {
  prepare_thread({.name = "twin", .priority = settings_.priority, .has_period = true});
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
  running_.emplace(text_of(settings), plugins_,
                   Deployment::Options{.on_line = {}, .on_note = std::move(note)}, settings.domain);
  runner_ = running_->find("loop");
  component_ = &dynamic_cast<LoopComponent&>(runner_->component());
  if (!settings.recording.empty()) running_->deployment().record(settings.recording, nullptr);
  running_->start();
}

int OurLoop::readers() const {
  const RemoteWriter* remote = runner_->outputs().front().topic().remote();
  return remote ? remote->matched_readers() : 0;
}

}  // namespace armature::bench
