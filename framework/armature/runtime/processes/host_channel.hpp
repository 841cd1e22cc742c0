// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "armature/runtime/hosts/host_link.hpp"
#include "armature/runtime/processes/control_channel.hpp"

namespace armature ARMATURE_EXPORT {

/// The way to one process of another host, or to its agent (HostLink::kAgent).
class HostChannel final : public ControlChannel {
 public:
  HostChannel(HostLink& link, std::string_view process) : link_{&link}, process_{process} {}
  void send(std::string_view line) override { link_->send(process_, line); }
  std::optional<std::string> receive() override { return link_->receive(process_); }
  bool lost() const override { return link_->lost(); }

 private:
  HostLink* link_;
  std::string process_;
};

}  // namespace armature
