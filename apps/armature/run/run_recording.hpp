// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "armature/runtime/deployment_file/deployment_config.hpp"
#include "run/console.hpp"
#include "run/run.hpp"

namespace armature {

// What becomes of the recording of a run, which the runtime writes: the page of its report, and one
// file where every process has written its own.

/// What a run that does not record itself records for its page, in the folder of a report.
inline constexpr const char* kRecordingForPage = "run.mcap";

/// report.html in the folder of a report.
std::filesystem::path page_file(const std::filesystem::path& folder);

/// Removes what an older run left there, if it is a file.
void remove_older(const std::filesystem::path& file);

/// A run that does not record itself records as much as its page shows, into the folder of its
/// report.
void record_for_page(DeploymentConfig& config, RunOptions& options);

/// Joins the recordings of all processes of this host into the one that the deployment names.
/// False, and the console is told why: one of them is missing, or they stay as they are.
bool joined(const std::filesystem::path& recording, const DeploymentConfig& config,
            Console& console);

/// Writes report.html of what the run has recorded; none: it has no recording of all of it. False:
/// the file could not be written.
bool page_written(const std::optional<std::filesystem::path>& recording,
                  const std::filesystem::path& folder, Console& console);

}  // namespace armature
