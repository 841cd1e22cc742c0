// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/node.hpp"

namespace armature::paper {

/// Figures of a reference file, by name and by place; a name that is not there throws.
class Figures {
 public:
  explicit Figures(const config::Node& node) : node_{&node} {}

  Figures operator[](std::string_view key) const;
  Figures operator[](std::size_t i) const { return Figures{node_->items()[i]}; }
  std::size_t size() const { return node_->items().size(); }
  bool has(std::string_view key) const { return node_->find(key) != nullptr; }

  double number() const;
  const std::string& text() const { return node_->text(); }
  Eigen::VectorXd numbers() const;
  /// A point in millimetres, in metres.
  Eigen::Vector3d point_m() const { return 1e-3 * numbers().head<3>(); }
  /// Four rows of four numbers.
  Eigen::Isometry3d transform() const;

 private:
  const config::Node* node_;
};

/// tests/data/dental_lamp_reference.yaml.
Figures dental_lamp();
/// tests/data/sr1_reference.yaml.
Figures sr1();
/// tests/data/dental_implant_reference.yaml.
Figures dental_implant();

}  // namespace armature::paper
