// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "armature/config/node.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature ARMATURE_EXPORT {

/// What the processes of one deployment know each other by: SHA-256 over the resolved file, the
/// documents that `robots:` and `rigs:` name, and the files that those name in turn (a
/// URDF, a calibration). Models and pictures are not part of it, and how a machine joins DDS
/// (`dds:`, `domain:`) is not.
std::string fingerprint_of(const config::Node& root, const DeploymentConfig& deployment);

}  // namespace armature
