// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace armature {

struct ReproduceOptions {
  std::string paper;      // "lamp", "sr1", "implant", "master"
  bool is_short = false;  // without what takes more than a few seconds
  bool json = false;
  std::optional<std::filesystem::path> out;
};

/// `armature reproduce`: tables and figures of a published system, computed by the plugins as they
/// are deployed, beside what the paper prints. Exit code 0 only when every row holds.
int reproduce_paper(const ReproduceOptions& options);

}  // namespace armature
