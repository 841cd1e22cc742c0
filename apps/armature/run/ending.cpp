// SPDX-License-Identifier: Apache-2.0
#include "run/ending.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "armature/runtime/reporting/write_atomically.hpp"
#include "armature/values/json_text.hpp"

namespace armature {

std::filesystem::path report_file(const std::filesystem::path& folder) {
  return folder / "report.json";
}

std::string ending(std::string_view status, const std::string& reason) {
  nlohmann::ordered_json json{{"status", status}};
  if (!reason.empty()) json["reason"] = reason;
  // What is wrong may quote a file that is no UTF-8.
  return json_text(json) + '\n';
}

void write_ending(const std::filesystem::path& folder, const std::string& ending) {
  try {
    write_atomically(report_file(folder), ending);
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "armature: {}\n", error.what());
  }
}

}  // namespace armature
