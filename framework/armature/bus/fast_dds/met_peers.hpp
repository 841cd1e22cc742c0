// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <set>

#include "armature/bus/fast_dds/discovery.hpp"

namespace armature ARMATURE_EXPORT {

/// The endpoints of the deployment's other processes that one of ours has met and that are there.
/// One that was lost for a moment and is met again counts once. Any thread.
class MetPeers {
 public:
  void met(const Guid& peer) {
    const std::scoped_lock lock{mutex_};
    peers_.insert(peer);
  }
  void gone(const Guid& other) {
    const std::scoped_lock lock{mutex_};
    peers_.erase(other);
  }
  int count() const {
    const std::scoped_lock lock{mutex_};
    return static_cast<int>(peers_.size());
  }

 private:
  mutable std::mutex mutex_;
  std::set<Guid> peers_;
};

}  // namespace armature
