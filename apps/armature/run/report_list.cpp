// SPDX-License-Identifier: Apache-2.0
#include "run/report_list.hpp"

#include <sys/stat.h>

#include <fstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "armature/recording/hash_chain.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kListName = "report.sha256";
constexpr std::string_view kBetween = "  ";  // of hash and name
constexpr std::size_t kHashSize = 64;

/// A name that leads nowhere else, and stands in the list as it is.
bool is_plain(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.find_first_of("/\\\n") == std::string::npos;
}

bool is_file(const fs::path& path) {
  std::error_code none;
  return fs::is_regular_file(fs::symlink_status(path, none));
}

/// Empty: it cannot be read.
std::string hash_of(const fs::path& file) {
  try {
    return sha256_of_file(file);
  } catch (const std::runtime_error&) {
    return {};
  }
}

}  // namespace

std::map<std::string, ReportList::File> ReportList::files() const {
  std::map<std::string, File> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator{folder_, none}) {
    struct stat status {};
    const std::string name = entry.path().filename().string();
    if (!is_plain(name) || lstat(entry.path().c_str(), &status) != 0) continue;
    if (!S_ISREG(status.st_mode)) continue;
    files[name] = {.number = status.st_ino,
                   .size = static_cast<std::uintmax_t>(status.st_size),
                   .changed_ns = status.st_mtim.tv_sec * 1'000'000'000 + status.st_mtim.tv_nsec};
  }
  return files;
}

void ReportList::add_what(const std::function<void()>& write) {
  const auto before = files();
  const auto add_new = [&] {
    for (const auto& [name, file] : files()) {
      const auto older = before.find(name);
      if (older == before.end() || older->second != file) add(name);
    }
  };
  try {
    write();
  } catch (...) {
    add_new();
    throw;
  }
  add_new();
}

void ReportList::write() const {
  std::string text;
  for (const std::string& name : names_) {
    if (!is_plain(name) || name == kListName || !is_file(folder_ / name)) continue;
    text += sha256_of_file(folder_ / name);
    text += kBetween;
    text += name + '\n';
  }
  write_atomically(folder_ / kListName, text);
}

std::vector<std::string> remove_listed_files(const fs::path& folder) {
  std::vector<std::string> changed;
  const fs::path list = folder / kListName;
  if (!is_file(list)) return changed;
  std::error_code none;
  std::ifstream lines{list};
  for (std::string line; std::getline(lines, line);) {
    constexpr std::size_t kNameAt = kHashSize + kBetween.size();
    if (line.size() <= kNameAt || line.substr(kHashSize, kBetween.size()) != kBetween) continue;
    const std::string name = line.substr(kNameAt);
    if (!is_plain(name) || !is_file(folder / name)) continue;
    if (hash_of(folder / name) == line.substr(0, kHashSize)) {
      fs::remove(folder / name, none);
    } else {
      changed.push_back(name);
    }
  }
  lines.close();
  fs::remove(list, none);
  return changed;
}

}  // namespace armature
