// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/library_folder.hpp"

#include <dlfcn.h>

namespace armature {

std::filesystem::path library_file() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<void*>(&library_folder), &info) == 0) return {};
  return std::filesystem::canonical(info.dli_fname);
}

std::filesystem::path library_folder() { return library_file().parent_path(); }

}  // namespace armature
