// SPDX-License-Identifier: Apache-2.0
#include "bench/running_deployment.hpp"

#include <utility>

#include "armature/config/document.hpp"
#include "armature/runtime/deployment/run_watch.hpp"

namespace armature::bench {
namespace {

DeploymentConfig config_of(const std::string& text, const PluginRegistry& plugins) {
  config::Problems problems;
  DeploymentConfig config = read_deployment(config::parse_text(text, "bench"), plugins, problems);
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

RunningDeployment::RunningDeployment(const std::string& text, PluginRegistry& plugins,
                                     Deployment::Options options, int domain)
    : deployment_{
          std::make_unique<Deployment>(config_of(text, plugins), plugins, std::move(options))} {
  deployment_->connect(plugins, domain);
}

RunningDeployment::~RunningDeployment() {
  end_ = true;
  if (thread_.joinable()) thread_.join();
  deployment_->end_recording();
}

ComponentRunner* RunningDeployment::find(std::string_view component) {
  for (const auto& runner : deployment_->runners()) {
    if (runner->name() == component) return runner.get();
  }
  return nullptr;
}

void RunningDeployment::start() {
  thread_ = std::thread{[this] {
    UntilEnd until_end{end_};
    deployment_->run(until_end);
  }};
}

}  // namespace armature::bench
