// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/output_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>

namespace armature {

void prepare_output_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error{
        fmt::format("cannot make the folder '{}': {}", folder.string(), error.message())};
  }
  std::string trial = (folder / ".armature-XXXXXX").string();
  const int file = mkstemp(trial.data());
  if (file < 0) {
    throw std::runtime_error{
        fmt::format("cannot write into '{}': {}", folder.string(), std::strerror(errno))};
  }
  close(file);
  unlink(trial.c_str());
}

}  // namespace armature
