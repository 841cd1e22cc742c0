// SPDX-License-Identifier: Apache-2.0
#include "sweep/finished_runs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "armature/values/json_text.hpp"

namespace armature::sweep {

using Json = nlohmann::ordered_json;

namespace {

/// Whether `line`, which has no end, was to become a line of a sweep.
bool is_begun(std::string_view line) {
  constexpr std::string_view kBegin = R"({"fingerprint":)";
  return line.starts_with(kBegin) || kBegin.starts_with(line);
}

/// A run that an interrupted sweep was about to start has its file open for some milliseconds more.
bool lock(int descriptor) {
  constexpr int kTries = 50;
  for (int i = 0; i < kTries; ++i) {
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  return false;
}

/// Nothing of what is nested deeper than a report is: what copies JSON calls itself at each level.
Json parsed(const std::string& line) {
  constexpr int kDeepest = 32;
  bool is_deep = false;
  const auto leave_out_deep = [&](int depth, Json::parse_event_t, const Json&) {
    is_deep = is_deep || depth > kDeepest;
    return depth <= kDeepest;
  };
  Json json = Json::parse(line, leave_out_deep, false);
  return is_deep ? Json{} : json;
}

}  // namespace

FinishedRuns::FinishedRuns(std::optional<std::filesystem::path> file) : file_{std::move(file)} {
  if (!file_) return;
  const auto refuse = [&](const std::string& why) {
    throw std::runtime_error(fmt::format("{}: {}", file_->string(), why));
  };
  descriptor_ = open(file_->c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_APPEND, 0600);
  if (descriptor_ < 0) refuse(std::strerror(errno));
  struct stat status {};
  fstat(descriptor_, &status);
  if (!S_ISREG(status.st_mode)) refuse("is no file; give another folder");
  if (!lock(descriptor_)) refuse("another sweep uses this folder");
  read();
}

FinishedRuns::~FinishedRuns() {
  if (descriptor_ >= 0) close(descriptor_);
}

void FinishedRuns::read() {
  std::ifstream in{*file_};
  std::size_t whole = 0;  // bytes of lines that are complete
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const bool is_torn = in.eof();  // its end of line is missing
    const Json read = parsed(line);
    const bool is_run = read.is_object() && read.contains("seed") && read.contains("report") &&
                        read.contains("fingerprint") && read["fingerprint"].is_string() &&
                        read["seed"].is_number_unsigned() && read["report"].is_object();
    if (is_torn && is_begun(line)) {
      if (ftruncate(descriptor_, static_cast<off_t>(whole)) != 0) {
        throw std::runtime_error(fmt::format("{}: {}", file_->string(), std::strerror(errno)));
      }
      return;
    }
    if (!is_run) {
      throw std::runtime_error(
          fmt::format("{}:{}: no line of a sweep; give another folder", file_->string(), number));
    }
    reports_[{read["fingerprint"], read["seed"]}] = read["report"];
    whole += line.size() + 1;
  }
}

const Json* FinishedRuns::find(const RunKey& key) const {
  const auto found = reports_.find(key);
  return found == reports_.end() ? nullptr : &found->second;
}

void FinishedRuns::add(const RunKey& key, Json report) {
  const std::string status = report.value("status", "");
  if (file_ && status != kCrashed && status != kTimedOut) {
    const Json line{{"fingerprint", key.fingerprint}, {"seed", key.seed}, {"report", report}};
    const std::string text = json_text(line) + '\n';
    for (std::size_t done = 0; done < text.size();) {
      const ssize_t count = write(descriptor_, text.data() + done, text.size() - done);
      if (count < 0) {
        throw std::runtime_error(
            fmt::format("cannot write {}: {}", file_->string(), std::strerror(errno)));
      }
      done += static_cast<std::size_t>(count);
    }
  }
  reports_[key] = std::move(report);
}

}  // namespace armature::sweep
