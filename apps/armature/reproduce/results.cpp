// SPDX-License-Identifier: Apache-2.0
#include "reproduce/results.hpp"

#include <stdexcept>
#include <utility>

namespace armature::reproduce {

void Results::point(const std::string& table, const std::string& row, const Eigen::Vector3d& at) {
  value(table, row + ".x", at.x());
  value(table, row + ".y", at.y());
  value(table, row + ".z", at.z());
}

double Results::value(const std::string& table, const std::string& row) const {
  const auto of_table = values_.find(table);
  if (of_table != values_.end()) {
    const auto of_row = of_table->second.find(row);
    if (of_row != of_table->second.end()) return of_row->second;
  }
  throw std::out_of_range("'" + row + "' of " + table + " was not computed");
}

void Results::curve(const std::string& figure, std::size_t panel, const std::string& name,
                    std::vector<double> x, std::vector<double> y, Look look) {
  curves_[figure].push_back({panel, name, look, std::move(x), std::move(y)});
}

}  // namespace armature::reproduce
