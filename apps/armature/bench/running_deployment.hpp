// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "armature/runtime/deployment/deployment.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"

namespace armature::bench {

/// A deployment that a bench makes of a text and runs on a thread of its own.
class RunningDeployment {
 public:
  /// Joins DDS. Keeps a reference to `plugins`. Throws what a deployment throws that cannot start.
  RunningDeployment(const std::string& text, PluginRegistry& plugins, Deployment::Options options,
                    int domain);
  /// Ends it.
  ~RunningDeployment();
  RunningDeployment(const RunningDeployment&) = delete;
  RunningDeployment& operator=(const RunningDeployment&) = delete;

  Deployment& deployment() { return *deployment_; }
  /// The runner of a component; nullptr when it is not here.
  ComponentRunner* find(std::string_view component);
  /// From then on it runs.
  void start();

 private:
  std::unique_ptr<Deployment> deployment_;
  std::atomic<bool> end_{false};
  std::thread thread_;
};

}  // namespace armature::bench
