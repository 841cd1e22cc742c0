// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <string_view>

#include "armature/config/node.hpp"

namespace armature::reproduce {

/// Numbers of a YAML file, by name and by place. What is not there, or is no number, throws
/// std::out_of_range or std::invalid_argument with its place. The node must outlive this.
class Numbers {
 public:
  explicit Numbers(const config::Node& node) : node_{&node} {}

  Numbers operator[](std::string_view key) const;
  Numbers operator[](std::size_t i) const { return Numbers{node_->items()[i]}; }
  std::size_t size() const { return node_->items().size(); }
  bool has(std::string_view key) const { return node_->find(key) != nullptr; }

  double number() const;
  const std::string& text() const { return node_->text(); }
  Eigen::VectorXd numbers() const;
  /// So many of them.
  Eigen::VectorXd numbers(std::size_t count) const;
  /// A point in millimetres, in metres.
  Eigen::Vector3d point_m() const { return 1e-3 * numbers(3); }
  /// Four rows of four numbers.
  Eigen::Isometry3d transform() const;

 private:
  const config::Node* node_;
};

}  // namespace armature::reproduce
