// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "armature/bus/fast_dds/receive_buffer.hpp"
#include "armature/bus/fast_dds/shared_memory.hpp"
#include "armature/bus/transport.hpp"

namespace armature ARMATURE_EXPORT {

struct FastDdsLink;

/// Topics to other processes over Fast DDS. Samples that were delivered must be released before it
/// is destroyed, and its writers and readers too.
class FastDdsTransport final : public Transport {
 public:
  static Expected<std::unique_ptr<Transport>> make(const TransportOptions& options);
  /// `shared_memory`: what is looked at before shared memory is used. `receive_buffer`: what the
  /// system is asked for to keep datagrams [B].
  static Expected<std::unique_ptr<Transport>> make(const TransportOptions& options,
                                                   const SharedMemory& shared_memory,
                                                   std::uint32_t receive_buffer = kReceiveBuffer);
  explicit FastDdsTransport(std::shared_ptr<FastDdsLink> link) : link_{std::move(link)} {}

  Expected<std::unique_ptr<RemoteWriter>> advertise(const TopicSpec& topic) override;
  Expected<std::unique_ptr<RemoteReader>> subscribe(
      const TopicSpec& topic, bool same_deployment_only,
      std::function<void(SampleRef)> deliver) override;

 private:
  std::shared_ptr<FastDdsLink> link_;
};

}  // namespace armature
