// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "armature/values/recent.hpp"

namespace armature ARMATURE_EXPORT {

/// Which of the transport's notes that a process fell silent are told. Every process of a
/// deployment hears that of every lost one, some of them on several topics, and all speak on one
/// terminal: a lost process is told once, by the first of the deployment's others. That is the main
/// process, and of the main process the one behind it. A process that was halted itself, and takes
/// all others for lost, is not believed.
class LostPeers {
 public:
  /// `processes`: of the deployment, the main one first; `own`: this one.
  LostPeers(std::string deployment, std::vector<std::string> processes, std::string own);

  /// `note` names the lost process as the transport does, by deployment, process, and pid and host
  /// in round brackets.
  bool is_told_here(std::string_view note);

 private:
  bool is_of(std::string_view note, const std::string& process) const;

  std::string deployment_;
  std::vector<std::string> processes_;
  std::string own_;
  Recent<std::string, std::monostate> reported_;  // "(pid 12 on host)", or the whole note
};

}  // namespace armature
