// SPDX-License-Identifier: Apache-2.0
#include "joint_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace armature::test {
namespace {

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream text{line + ','};
  for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
  return fields;
}

}  // namespace

std::size_t JointTable::column(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  EXPECT_NE(found, names.end()) << name;
  return static_cast<std::size_t>(found - names.begin()) % names.size();
}

std::vector<std::size_t> JointTable::positions() const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& name = names[i];
    const bool is_length_or_angle = name.ends_with("_rad") || name.ends_with("_m");
    const bool is_compared =
        name.find("_error_") != std::string::npos || name.find("_reference_") != std::string::npos;
    if (is_length_or_angle && !is_compared) found.push_back(i);
  }
  return found;
}

JointTable read_joint_table(const std::string& text) {
  JointTable table;
  EXPECT_TRUE(text.ends_with("\r\n"));
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(line.ends_with('\r')) << line;
    line.pop_back();
    const auto fields = fields_of(line);
    if (table.names.empty()) {
      table.names = fields;
      continue;
    }
    EXPECT_EQ(fields.size(), table.names.size()) << line;
    auto& row = table.rows.emplace_back();
    for (const std::string& field : fields) row.push_back(field.empty() ? NAN : std::stod(field));
  }
  return table;
}

}  // namespace armature::test
