// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace armature ARMATURE_EXPORT {

/// While it lives, Fast DDS writes nothing to the console; its errors go to `on_error`, each
/// distinct text once. Fast DDS has one log per process: one of these at a time.
class DdsLog {
 public:
  explicit DdsLog(std::function<void(const std::string&)> on_error);
  ~DdsLog();
  DdsLog(const DdsLog&) = delete;
  DdsLog& operator=(const DdsLog&) = delete;
};

}  // namespace armature
