// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "armature/messages/armature_msgs.hpp"
#include "armature/recording/mcap_queue.hpp"
#include "armature/recording/recorded_processes.hpp"

namespace armature ARMATURE_EXPORT {

/// Names of the metadata in a recording.
inline constexpr std::string_view kDeploymentMetadata = "armature.deployment";
inline constexpr std::string_view kComponentMetadata = "armature.component";
/// Key of the metadata kEndMetadata: how many activations the process has numbered.
inline constexpr const char* kActivationsKey = "activations";
/// Another: how many messages a thin recording has left out.
inline constexpr const char* kThinnedKey = "thinned";
/// Keys of the metadata of a process on another host than the main one: its name, and by how many
/// seconds the deployment's clock, by which everything is recorded, was ahead of its own.
inline constexpr const char* kHostKey = "host";
inline constexpr const char* kClockAheadKey = "clock_ahead_s";

/// Name of the attachment with the figures of the run (figures_json): of its main process, and of a
/// run that came to its end.
inline constexpr std::string_view kFiguresAttachment = "figures.json";

/// Puts what a deployment was made from into a recording: the file, its robots and rigs as
/// attachments, `dental_lamp/dental_lamp.yaml`, `dental_lamp/robots/arm.yaml`, and as metadata its
/// fingerprint and where those files were. `at` is when it was told.
void attach_description(const msg::DeploymentDescription& description, Time at, McapQueue& queue);

}  // namespace armature
