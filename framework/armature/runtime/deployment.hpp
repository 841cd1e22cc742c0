// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "armature/runtime/clock.hpp"
#include "armature/runtime/component_setup.hpp"
#include "armature/runtime/deployment_config.hpp"
#include "armature/runtime/outside.hpp"
#include "armature/runtime/scheduler.hpp"
#include "armature/runtime/unit.hpp"

namespace armature {

/// A deployment in memory: topics, units, scheduler, and the way to other processes. Built in
/// three steps, each of which throws with every problem it finds: the configuration is read
/// (read_deployment), the components are constructed (here), the transport is joined (connect).
class Deployment {
 public:
  struct Options {
    std::string process{kMainProcess};  // constructs only its components; empty: all of them
    Voice::Sink on_line;                // what components tell the operator
    std::function<void(const std::string&)> on_note;  // what the runtime tells the operator
  };

  /// Loads the plugins and constructs the components. Throws config::ConfigError (a plugin refuses
  /// its parameters or robot) or PluginError (a library cannot be used).
  Deployment(DeploymentConfig config, PluginRegistry& plugins, Options options);
  ~Deployment();
  Deployment(const Deployment&) = delete;
  Deployment& operator=(const Deployment&) = delete;

  const DeploymentConfig& config() const { return config_; }
  const Clock& clock() const { return *clock_; }
  const std::vector<std::unique_ptr<Unit>>& units() const { return units_; }
  /// The entry of the deployment that `unit` was made from.
  const ComponentConfig& config_of(const Unit& unit) const;

  /// Joins the DDS domain: writers for every output, readers only for inputs that another process
  /// feeds. Throws PluginError with the transport's reason.
  void connect(PluginRegistry& plugins, int domain);

  /// Waits until the other processes have joined, so that what is sent once is not lost: at most
  /// five seconds, and then says which topic has nobody. Then runs until `done`, or a component is
  /// finished, or the time limit; then stops everything, sources first.
  void run(const std::function<bool()>& done);

  bool any_finished() const;
  /// True when the run ended because its time limit was over.
  bool timed_out() const { return timed_out_; }
  /// The first fault, or empty.
  std::string fault() const;

 private:
  void make_scheduler();
  void make_unit(const ComponentConfig& component, PluginRegistry& plugins,
                 config::Problems& problems);
  void make_own_units(PluginRegistry& plugins);
  void make_own_unit(std::string_view name, const PluginManifest& manifest, int place,
                     PluginRegistry& plugins,
                     const std::function<std::unique_ptr<Component>(Setup&)>& make);
  /// The entry of what the runtime itself adds to `process`.
  ComponentConfig own_config(std::string_view name, const PluginManifest& manifest, int place,
                             const std::string& process) const;
  ComponentSetup setup_of(const ComponentConfig& component, PluginRegistry& plugins, Unit& unit);
  Topic& topic_for(const ComponentConfig& component, const PortBinding& port,
                   const MessageType& type);
  Topic& topic_at(const std::string& key, const PortBinding& port, const MessageType& type);
  void await_processes(const std::function<bool()>& done);
  void assign_units();
  void stop();

  DeploymentConfig config_;
  Options options_;
  std::unique_ptr<Clock> clock_;
  std::map<std::string, std::unique_ptr<Topic>> topics_;  // by name, of shared ones also by writer
  std::unique_ptr<Scheduler> scheduler_;
  std::vector<std::unique_ptr<Unit>> units_;  // in the order of the graph
  bool timed_out_ = false;
  std::optional<Outside> outside_;  // the topics that it has writers of go first
};

}  // namespace armature
