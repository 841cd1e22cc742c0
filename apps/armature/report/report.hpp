// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>

namespace armature {

struct ReportOptions {
  std::filesystem::path recording, out;
  std::filesystem::path page;  // of `armature monitor`; empty: the one that came with armature
  bool pictures = true;
  bool force = false;  // replace a file that is there
};

/// Writes one page that needs no other file and no network: that of `armature monitor` with the
/// recording in it, which it opens by itself. What takes room and shows nothing more is left out:
/// see docs/recording.md. Throws InvalidChoice for files that are not as they should be.
int write_report(const ReportOptions& options);

}  // namespace armature
