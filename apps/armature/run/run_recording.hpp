// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "armature/runtime/deployment/deployment.hpp"
#include "run/console.hpp"
#include "run/run.hpp"

namespace armature {

// The recording of a run, which the runtime writes: where, and what becomes of it: the page of its
// report, and one file where every process has written its own.

/// Throws where a process of the main host would write over a recording that is there. `start`: of
/// the run, by the system's clock.
void check_recordings(const DeploymentConfig& config, Time start);
/// The same of one process.
void check_recording(const DeploymentConfig& config, const std::string& process, Time start);

/// As `record:` says, from before the first activation of `process` on. The file of the whole run,
/// if it has one.
std::optional<std::filesystem::path> begin_recording(Deployment& deployment,
                                                     const std::string& process, Time start);

/// Leaves none of a run that has not begun, on this host: it would stop the next start.
void remove_recordings(const std::filesystem::path& recording, const DeploymentConfig& config);

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
