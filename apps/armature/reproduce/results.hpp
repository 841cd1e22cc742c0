// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "armature/plot/chart.hpp"

namespace armature::reproduce {

/// The greater one, or no number when one of them is none: a value that was not computed must not
/// hide behind those that were.
inline double worst(double a, double b) { return a > b || a != a ? a : b; }

/// What was computed for a paper: values for the rows of its tables, curves for its figures.
class Results {
 public:
  void value(const std::string& table, const std::string& row, double value) {
    values_[table][row] = value;
  }
  /// Rows "<row>.x", "<row>.y", "<row>.z".
  void point(const std::string& table, const std::string& row, const Eigen::Vector3d& at);
  /// Throws std::out_of_range with the names when it was not computed.
  double value(const std::string& table, const std::string& row) const;

  enum class Look { line, dashed, dots };
  /// A curve in a panel of a figure, counted from 0. Curves of one name have one colour.
  void curve(const std::string& figure, std::size_t panel, const std::string& name,
             std::vector<double> x, std::vector<double> y, Look look = Look::line);

  using Values = std::map<std::string, std::map<std::string, double>>;  // by table and row
  const Values& values() const { return values_; }

  struct Curve {
    std::size_t panel;
    std::string name;
    Look look;
    std::vector<double> x, y;
  };
  using Curves = std::map<std::string, std::vector<Curve>>;  // by figure
  const Curves& curves() const { return curves_; }

 private:
  Values values_;
  Curves curves_;
};

}  // namespace armature::reproduce
