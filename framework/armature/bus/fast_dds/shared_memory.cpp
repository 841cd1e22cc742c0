// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/shared_memory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace armature {
namespace {

namespace fs = std::filesystem;

/// A file whose advisory lock we got: nobody else holds it while this lives.
class FreeLock {
 public:
  explicit FreeLock(const fs::path& file)
      : fd_{open(file.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC)} {
    free_ = fd_ >= 0 && flock(fd_, LOCK_EX | LOCK_NB) == 0;
  }
  ~FreeLock() {
    if (fd_ >= 0) close(fd_);
  }
  FreeLock(const FreeLock&) = delete;
  FreeLock& operator=(const FreeLock&) = delete;
  bool free() const { return free_; }

 private:
  int fd_;
  bool free_ = false;
};

/// Whether this process holds the lock of a file. That it is open says nothing: whoever sends there
/// has opened it.
bool is_locked_here(const fs::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return false;
  std::ifstream locks{"/proc/locks"};  // "1: FLOCK ADVISORY WRITE 1234 00:1a:5678 0 EOF"
  std::string number, kind, advisory, access, pid, place;
  for (std::string line; std::getline(locks, line);) {
    std::istringstream{line} >> number >> kind >> advisory >> access >> pid >> place;
    if (kind == "FLOCK" && pid == std::to_string(getpid()) &&
        place.ends_with(":" + std::to_string(status.st_ino))) {
      return true;
    }
  }
  return false;
}

bool is_mine(const fs::path& file) {
  struct stat status {};
  return lstat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid();
}

/// What is done with a file that a dead process left.
using FileAction = std::function<void(const fs::path&)>;

/// A segment or port "fastrtps_x", its locks (one owner, several readers) and its mutex.
std::array<fs::path, 4> group_of(const fs::path& folder, const std::string& name) {
  return {folder / name, folder / (name + "_el"), folder / (name + "_sl"),
          folder / ("sem." + name + "_mutex")};
}

/// Does `act` with all of a group while its locks are held, or nothing when any sign of life is
/// found.
void for_dead_group(const fs::path& folder, const std::string& name,
                    const std::set<fs::path>& in_use, const FileAction& act) {
  const auto group = group_of(folder, name);
  for (const fs::path& file : group) {
    if (fs::exists(file) && (in_use.contains(file) || !is_mine(file))) return;
  }
  const FreeLock exclusive{group[1]};
  const FreeLock shared{group[2]};
  if (fs::exists(group[1]) && !exclusive.free()) return;
  if (fs::exists(group[2]) && !shared.free()) return;
  for (const fs::path& file : group) {
    if (fs::exists(file)) act(file);
  }
}

/// "fastrtps_x" of any file of its group; empty for other files.
std::string group_name(std::string name) {
  for (const std::string_view suffix : {"_el", "_sl", "_mutex"}) {
    if (name.ends_with(suffix)) name.erase(name.size() - suffix.size());
  }
  if (name.starts_with("sem.")) name.erase(0, 4);
  return name.starts_with("fastrtps_") ? name : "";
}

/// The files of `folder` that the process of `proc_folder` has mapped.
void add_mapped_files(const fs::path& proc_folder, const fs::path& folder,
                      std::set<fs::path>& files) {
  std::ifstream maps{proc_folder / "maps"};
  for (std::string line; std::getline(maps, line);) {
    const std::size_t path = line.find(folder.string() + "/");
    if (path != std::string::npos) files.insert(line.substr(path));
  }
}

/// The files that the process of `proc_folder` has open.
std::set<fs::path> open_files(const fs::path& proc_folder) {
  std::set<fs::path> files;
  std::error_code error;
  for (const auto& open : fs::directory_iterator{proc_folder / "fd", error}) {
    files.insert(fs::read_symlink(open.path(), error));
  }
  return files;
}

/// The files of `folder` that some process has open or mapped (of those processes that may be
/// looked at: this user's, and nobody else may write the files). Whoever makes a file has it open
/// at once, and mapped before he closes it: so what is open is looked at first, and a file that was
/// there before this call is found while it lives, however young it is.
std::set<fs::path> files_in_use(const fs::path& folder) {
  const std::string inside = folder.string() + "/";
  std::set<fs::path> files;
  std::error_code error;
  for (const auto& process : fs::directory_iterator{"/proc", error}) {
    for (const fs::path& file : open_files(process.path())) {
      if (file.string().starts_with(inside)) files.insert(file);
    }
    add_mapped_files(process.path(), folder, files);
  }
  return files;
}

/// Of a file of this user; a link is left alone.
void make_private(const fs::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat status {};
  if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid()) {
    fchmod(descriptor, 0600);
  }
  close(descriptor);
}

/// The low 16 bits of every running process' id.
std::set<unsigned> running_processes() {
  std::set<unsigned> low_bits;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator{"/proc", error}) {
    const std::string name = entry.path().filename();
    unsigned pid = 0;
    const auto [end, status] = std::from_chars(name.data(), name.data() + name.size(), pid);
    if (status == std::errc{} && end == name.data() + name.size()) low_bits.insert(pid & 0xffffU);
  }
  return low_bits;
}

/// The low 16 bits of the process id stand in bytes 5 and 6 of the GUID prefix, low byte first:
/// "fast_datasharing_01.0f.78.fd.94.2e.fc...".
bool is_process_gone(std::string_view guid_text, const std::set<unsigned>& running) {
  unsigned bytes[6] = {};
  for (unsigned& byte : bytes) {
    const auto [end, error] =
        std::from_chars(guid_text.data(), guid_text.data() + guid_text.size(), byte, 16);
    if (error != std::errc{} || end == guid_text.data() + guid_text.size() || *end != '.') {
      return false;
    }
    guid_text.remove_prefix(static_cast<std::size_t>(end - guid_text.data()) + 1);
  }
  return !running.empty() && !running.contains(bytes[4] | bytes[5] << 8);
}

/// Does `act` with every file that killed processes of this user left in `folder`.
void for_left_over(const fs::path& folder, const FileAction& act) {
  constexpr std::string_view kDataSharing = "fast_datasharing_";
  std::set<std::string> groups;
  std::vector<std::string> data_sharing;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator{folder, error}) {
    const std::string name = entry.path().filename();
    if (const std::string group = group_name(name); !group.empty()) groups.insert(group);
    if (name.starts_with(kDataSharing)) data_sharing.push_back(name);
  }
  if (groups.empty() && data_sharing.empty()) return;

  const std::set<fs::path> in_use = files_in_use(folder);
  const std::set<unsigned> running = running_processes();
  for (const std::string& name : groups) for_dead_group(folder, name, in_use, act);
  for (const std::string& name : data_sharing) {
    const fs::path file = folder / name;
    if (is_mine(file) && !in_use.contains(file) &&
        is_process_gone(std::string_view{name}.substr(kDataSharing.size()), running)) {
      act(file);
    }
  }
}

}  // namespace

Expected<std::uint64_t> free_bytes_of(const fs::path& folder) {
  struct statvfs status {};
  if (statvfs(folder.c_str(), &status) != 0) {
    return refuse(folder.string() + ": " + std::strerror(errno));
  }
  return std::uint64_t{status.f_bavail} * status.f_frsize;
}

Expected<void> check_shared_memory(const SharedMemory& memory, std::uint64_t bytes) {
  const std::string folder = memory.folder.string();
  std::string probe = (memory.folder / "armature_probe_XXXXXX").string();
  const int fd = mkostemp(probe.data(), O_CLOEXEC);
  if (fd < 0) return refuse(folder + " is not writable: " + std::strerror(errno));
  close(fd);
  unlink(probe.c_str());

  const auto free_bytes = memory.free_bytes(memory.folder);
  if (!free_bytes) return tl::unexpected{free_bytes.error()};
  if (*free_bytes < bytes) {
    return refuse(folder + " has " + std::to_string(*free_bytes >> 20) + " MiB free, " +
                  std::to_string(bytes >> 20) + " MiB are needed");
  }
  return {};
}

Expected<void> check_shared_memory_port(const fs::path& folder, std::uint32_t port) {
  const fs::path file = folder / ("fastrtps_port" + std::to_string(port));
  if (access(file.c_str(), R_OK | W_OK) != 0) {
    return refuse(file.string() + ": " + std::strerror(errno));
  }
  const fs::path listens = group_of(folder, file.filename())[1];  // held by whoever does
  if (is_locked_here(listens)) return refuse(file.string() + " is its own");
  if (!fs::exists(listens) || FreeLock{listens}.free()) {
    return refuse("nobody listens at " + file.string());
  }
  return {};
}

void make_shared_memory_private(const fs::path& folder) {
  std::set<fs::path> mapped;
  add_mapped_files("/proc/self", folder, mapped);
  for (const fs::path& file : mapped) {
    const std::string name = group_name(file.filename());
    if (name.empty()) continue;
    for (const fs::path& member : group_of(folder, name)) make_private(member);
  }
}

int clean_shared_memory(const fs::path& folder) {
  int removed = 0;
  for_left_over(folder, [&](const fs::path& file) { removed += unlink(file.c_str()) == 0; });
  return removed;
}

std::vector<fs::path> left_in_shared_memory(const fs::path& folder) {
  std::vector<fs::path> files;
  for_left_over(folder, [&](const fs::path& file) { files.push_back(file); });
  return files;
}

}  // namespace armature
