// SPDX-License-Identifier: Apache-2.0
#include "sweep/finished_runs.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace armature::sweep {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

FinishedRuns::FinishedRuns(std::optional<std::filesystem::path> file) : file_{std::move(file)} {
  if (!file_ || !std::filesystem::exists(*file_)) return;
  std::ifstream in{*file_};
  if (!in) {
    throw std::runtime_error(fmt::format("cannot read {}: {}", file_->string(), strerror(errno)));
  }
  std::size_t whole = 0;  // bytes of lines that are complete
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (in.eof()) break;  // its end of line is missing: cut off
    const Json read = Json::parse(line, nullptr, false);
    if (!read.is_object() || !read.contains("fingerprint") || !read.contains("seed") ||
        !read.contains("report")) {
      throw std::runtime_error(
          fmt::format("{}:{}: no line of a sweep; give another folder", file_->string(), number));
    }
    reports_[{read["fingerprint"], read["seed"]}] = read["report"];
    whole += line.size() + 1;
  }
  in.close();
  std::filesystem::resize_file(*file_, whole);
}

const Json* FinishedRuns::find(const RunKey& key) const {
  const auto found = reports_.find(key);
  return found == reports_.end() ? nullptr : &found->second;
}

void FinishedRuns::add(const RunKey& key, Json report) {
  if (file_ && report.value("status", "") != kCrashed) {
    std::ofstream out{*file_, std::ios::app};
    const Json line{{"fingerprint", key.fingerprint}, {"seed", key.seed}, {"report", report}};
    out << line.dump() << '\n' << std::flush;
    if (!out) {
      throw std::runtime_error(
          fmt::format("cannot write {}: {}", file_->string(), strerror(errno)));
    }
  }
  reports_[key] = std::move(report);
}

}  // namespace armature::sweep
