// SPDX-License-Identifier: Apache-2.0
#include "reproduce/numbers.hpp"

#include <stdexcept>

namespace armature::reproduce {

Numbers Numbers::operator[](std::string_view key) const {
  const config::Node* value = node_->find(key);
  if (!value) throw std::out_of_range(node_->origin().text() + ": no " + std::string{key});
  return Numbers{*value};
}

double Numbers::number() const {
  try {
    return std::stod(node_->text());
  } catch (const std::exception&) {
    throw std::invalid_argument(node_->origin().text() + ": " + node_->describe() +
                                " is no number");
  }
}

Eigen::VectorXd Numbers::numbers() const {
  Eigen::VectorXd result(static_cast<Eigen::Index>(size()));
  for (std::size_t i = 0; i < size(); ++i) {
    result[static_cast<Eigen::Index>(i)] = (*this)[i].number();
  }
  return result;
}

Eigen::Isometry3d Numbers::transform() const {
  Eigen::Isometry3d result;
  for (std::size_t row = 0; row < 4; ++row) {
    result.matrix().row(static_cast<Eigen::Index>(row)) = (*this)[row].numbers();
  }
  return result;
}

}  // namespace armature::reproduce
