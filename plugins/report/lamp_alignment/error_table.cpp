// SPDX-License-Identifier: Apache-2.0
#include "error_table.hpp"

#include <fmt/format.h>

#include <iterator>
#include <optional>
#include <string>

#include "armature/runtime/reporting/write_atomically.hpp"

namespace armature::report::lamp_alignment {

void write_error_table(std::span<const LampError> errors, const std::filesystem::path& file) {
  std::string table =
      "time_s,distance_m,distance_error_m,direction_error_rad,mouth_error_m,normal_error_rad\n";
  const auto known = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.9g}", *value) : std::string{};
  };
  for (const LampError& error : errors) {
    fmt::format_to(std::back_inserter(table), "{:.6f},{:.9g},{},{:.9g},{},{}\n", error.time_s,
                   error.distance_m, known(error.distance_error_m), error.direction_error_rad,
                   known(error.mouth_error_m), known(error.normal_error_rad));
  }
  write_atomically(file, table);
}

}  // namespace armature::report::lamp_alignment
