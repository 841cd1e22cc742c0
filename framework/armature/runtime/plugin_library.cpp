// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugin_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <optional>

#include "armature/runtime/abi.hpp"
#include "armature/runtime/elf_section.hpp"

namespace armature {
namespace {

/// Loads the library in a child process first: one that crashes while it is loaded takes only the
/// child with it.
Expected<void> survives_loading(const std::filesystem::path& file) {
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) return refuse(fmt::format("cannot fork to try it: {}", std::strerror(errno)));
  if (child == 0) {
    // Not left behind with what it inherited (the instance lock) when the program is killed.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(0);
    for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) {
      std::signal(signal, SIG_DFL);
    }
    // Whatever it prints in its last moments is not ours to show.
    std::freopen("/dev/null", "w", stderr);
    dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    _exit(0);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) {
    return refuse(fmt::format("it crashes when it is loaded ({})", strsignal(WTERMSIG(status))));
  }
  if (WEXITSTATUS(status) != 0) {
    return refuse(
        fmt::format("it ends the process when it is loaded (exit code {})", WEXITSTATUS(status)));
  }
  return {};
}

std::optional<std::string> wrong_entry(const PluginEntry& entry, std::string_view kind,
                                       int kind_version) {
  if (entry.kind != kind) {
    return fmt::format("its class is of kind '{}', wanted '{}'", entry.kind, kind);
  }
  if (entry.kind_version != kind_version) {
    return fmt::format("it implements version {} of kind '{}', this is version {}",
                       entry.kind_version, kind, kind_version);
  }
  return std::nullopt;
}

}  // namespace

Expected<std::shared_ptr<PluginLibrary>> PluginLibrary::of_this_program(const PluginEntry& entry,
                                                                        std::string_view kind,
                                                                        int kind_version) {
  if (auto wrong = wrong_entry(entry, kind, kind_version)) return refuse(*wrong);
  return std::shared_ptr<PluginLibrary>(new PluginLibrary({}, nullptr, entry));
}

Expected<std::shared_ptr<PluginLibrary>> PluginLibrary::load(const std::filesystem::path& file,
                                                             std::string_view kind,
                                                             int kind_version) {
  const auto sections = read_elf_sections(file, {".armature.abi"});
  if (!sections) return tl::unexpected{sections.error()};
  const auto abi = sections->find(".armature.abi");
  if (abi == sections->end())
    return refuse("it carries no ABI tag: not built as an Armature plugin");
  if (abi->second != ARMATURE_ABI_TAG) {
    return refuse(fmt::format("built for [{}], this is [{}]; rebuild the plugin", abi->second,
                              ARMATURE_ABI_TAG));
  }
  if (const auto survives = survives_loading(file); !survives) {
    return tl::unexpected{survives.error()};
  }
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) return refuse(dlerror());
  const auto* entry = static_cast<const PluginEntry*>(dlsym(handle, "armature_plugin_entry"));
  const auto wrong = entry ? wrong_entry(*entry, kind, kind_version)
                           : std::optional<std::string>{"it has no ARMATURE_PLUGIN(...) line"};
  if (wrong) {
    dlclose(handle);
    return refuse(*wrong);
  }
  return std::shared_ptr<PluginLibrary>(new PluginLibrary(file, handle, *entry));
}

PluginLibrary::~PluginLibrary() {
  if (handle_) dlclose(handle_);
}

}  // namespace armature
