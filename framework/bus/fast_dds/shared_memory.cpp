// SPDX-License-Identifier: Apache-2.0
#include "armature/bus/fast_dds/shared_memory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <ctime>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace armature {
namespace {

namespace fs = std::filesystem;

/// A file whose advisory lock we got: nobody else holds it while this lives.
class FreeLock {
 public:
  explicit FreeLock(const fs::path& file) : fd_{open(file.c_str(), O_RDWR | O_CLOEXEC)} {
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

bool is_old_and_mine(const fs::path& file, double least_age_s) {
  struct stat status {};
  if (lstat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  return status.st_uid == geteuid() &&
         std::difftime(std::time(nullptr), status.st_ctim.tv_sec) >= least_age_s;
}

int remove_file(const fs::path& file) { return unlink(file.c_str()) == 0 ? 1 : 0; }

/// "<name>" with its locks "<name>_el" (one owner) and "<name>_sl" (several readers).
int clean_locked_file(const fs::path& file, double least_age_s) {
  const fs::path exclusive = file.string() + "_el";
  const fs::path shared = file.string() + "_sl";
  const bool has_exclusive = fs::exists(exclusive);
  const bool has_shared = fs::exists(shared);
  if (!has_exclusive && !has_shared) return 0;  // no lock, no proof
  if (has_exclusive && !is_old_and_mine(exclusive, least_age_s)) return 0;
  if (has_shared && !is_old_and_mine(shared, least_age_s)) return 0;
  const FreeLock exclusive_lock{exclusive};
  const FreeLock shared_lock{shared};
  if (has_exclusive && !exclusive_lock.free()) return 0;
  if (has_shared && !shared_lock.free()) return 0;
  int removed = remove_file(file);
  removed += remove_file(file.parent_path() / ("sem." + file.filename().string() + "_mutex"));
  if (has_exclusive) removed += remove_file(exclusive);
  if (has_shared) removed += remove_file(shared);
  return removed;
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

}  // namespace

Expected<void> check_shared_memory(const fs::path& folder, std::uint64_t bytes) {
  std::string probe = (folder / "armature_probe_XXXXXX").string();
  const int fd = mkostemp(probe.data(), O_CLOEXEC);
  if (fd < 0) return refuse(folder.string() + " is not writable: " + std::strerror(errno));
  close(fd);
  unlink(probe.c_str());

  struct statvfs status {};
  if (statvfs(folder.c_str(), &status) != 0) {
    return refuse(folder.string() + ": " + std::strerror(errno));
  }
  const std::uint64_t free_bytes = std::uint64_t{status.f_bavail} * status.f_frsize;
  if (free_bytes < bytes) {
    return refuse(folder.string() + " has " + std::to_string(free_bytes >> 20) + " MiB free, " +
                  std::to_string(bytes >> 20) + " MiB are needed");
  }
  return {};
}

int clean_shared_memory(const fs::path& folder, double least_age_s) {
  const std::set<unsigned> running = running_processes();
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator{folder, error}) files.push_back(entry.path());

  constexpr std::string_view kDataSharing = "fast_datasharing_";
  int removed = 0;
  for (const fs::path& file : files) {
    const std::string name = file.filename();
    if (name.starts_with(kDataSharing)) {
      if (is_old_and_mine(file, least_age_s) &&
          is_process_gone(std::string_view{name}.substr(kDataSharing.size()), running)) {
        removed += remove_file(file);
      }
    } else if (name.starts_with("fastrtps_") && !name.ends_with("_el") && !name.ends_with("_sl")) {
      if (is_old_and_mine(file, least_age_s)) removed += clean_locked_file(file, least_age_s);
    }
  }
  return removed;
}

}  // namespace armature
