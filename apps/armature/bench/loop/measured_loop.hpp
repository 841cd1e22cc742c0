// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include "bench/loop/loop_work.hpp"
#include "bench/running_deployment.hpp"

namespace armature::bench {

/// How a measured loop runs.
struct LoopSettings {
  double period_s = 0.001;
  int priority = 0;            // SCHED_FIFO; 0: the normal scheduler
  int domain = 0;              // of our own loop
  std::string recording = {};  // file that our own one records itself into; empty: it does not
};

/// A loop at a fixed period whose lateness is measured.
class MeasuredLoop {
 public:
  virtual ~MeasuredLoop() = default;
  virtual const TimingHistogram& lateness() const = 0;
  virtual Requests& requests() = 0;
};

/// The least that a periodic thread can be: clock_nanosleep to absolute instants, the tiny work,
/// nothing else.
class Twin final : public MeasuredLoop {
 public:
  explicit Twin(const LoopSettings& settings);
  ~Twin() override;
  const TimingHistogram& lateness() const override { return lateness_; }
  Requests& requests() override { return requests_; }

 private:
  void loop();

  LoopSettings settings_;
  TimingHistogram lateness_;
  Requests requests_;
  std::atomic<bool> end_{false};
  std::thread thread_;
};

/// A deployment of one component on one executor, joined to DDS as every deployment is.
class OurLoop final : public MeasuredLoop {
 public:
  /// Throws what a deployment throws that cannot start. `note` is called with what the system does
  /// not allow.
  OurLoop(const LoopSettings& settings, std::function<void(const std::string&)> note);
  const TimingHistogram& lateness() const override { return runner_->times().lateness; }
  Requests& requests() override { return component_->requests(); }
  /// How many other processes read its joint state now.
  int readers() const;

 private:
  PluginRegistry plugins_;
  std::optional<RunningDeployment> running_;
  ComponentRunner* runner_ = nullptr;
  LoopComponent* component_ = nullptr;
};

}  // namespace armature::bench
