// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>

#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "armature/runtime/execution/component_runner.hpp"

namespace armature ARMATURE_EXPORT {

/// What a plugin in a slot refuses, at the slot's own line where the file has one. The units of a
/// component say the same of it.
config::Problem problem_of(const ComponentConfig& component, const SlotError& error);

/// What the deployment hands to a component's constructor, made from its entry in the file. Checks
/// that the class claims exactly the ports that its plugin.yaml declares.
class ComponentSetup final : public Setup {
 public:
  using FindTopic = std::function<Topic&(const PortBinding&, const MessageType&)>;

  ComponentSetup(const ComponentConfig& config, const DeploymentConfig& deployment,
                 PluginRegistry& plugins, ComponentRunner& runner, Delivery& delivery,
                 FindTopic find_topic, std::optional<NetworkOptions> network = {});

  const std::string& name() const override { return config_.name; }
  std::string_view unit() const override { return config_.unit; }
  const Params& params() const override { return config_.params; }
  std::uint64_t seed() const override;
  const config::Node& document(std::string_view section) override;
  bool has_document(std::string_view section) const override;
  void activate_every(Duration period) override;
  void deliver_after(Duration latency) override { runner_.set_latency(latency); }
  bool is_written(std::string_view input) const override;
  std::optional<NetworkOptions> network() const override { return network_; }
  Duration stop_within() const override { return seconds(deployment_.stop_within_s); }
  bool is_filled(std::string_view slot_name) const override;
  const PluginManifest& slot_manifest(std::string_view slot_name) const override;
  std::shared_ptr<StatusReporter> reporter() override { return runner_.reporter(); }

  /// Throws std::logic_error when a declared port was never claimed.
  void check_all_claimed() const;

 protected:
  InputPort& claim_input(std::string_view port, const MessageType& type) override;
  OutputPort& claim_output(std::string_view port, const MessageType& type) override;
  SlotPlugin slot_plugin(std::string_view slot, std::string_view kind) override;
  void keep_slot(std::unique_ptr<SlotPlace> place) override {
    runner_.slots().push_back(std::move(place));
  }
  void keep_thread(std::unique_ptr<DriverThread> thread) override;

 private:
  /// Tells an input whose measurements it gets, and whether they are answered to.
  void set_source(InputPort& input, const PortBinding& binding) const;
  const SlotConfig& slot_config(std::string_view slot_name) const;
  const PortBinding& declared(const std::vector<PortBinding>& ports, std::string_view direction,
                              std::string_view name, const MessageType& type);

  const ComponentConfig& config_;
  const DeploymentConfig& deployment_;
  PluginRegistry& plugins_;
  ComponentRunner& runner_;
  Delivery& delivery_;
  FindTopic find_topic_;
  std::optional<NetworkOptions> network_;
  std::set<const PortBinding*> claimed_;
};

}  // namespace armature
