// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace armature {

/// A folder of what came with this program: "configs" with deployments, robots and rigs, "papers".
std::filesystem::path shipped_folder(const std::string& name);
inline std::filesystem::path shipped_config_folder() { return shipped_folder("configs"); }

/// The deployments among them, sorted.
std::vector<std::filesystem::path> shipped_deployments();
/// The robot files among them, sorted.
std::vector<std::filesystem::path> shipped_robots();

/// The file that a command line means by `given`: that file, or for a name without folder and
/// ending ("dental_lamp") the shipped deployment of that name. Throws InvalidChoice with the
/// nearest names when there is neither.
std::string deployment_file(const std::string& given);

}  // namespace armature
