// SPDX-License-Identifier: Apache-2.0
#include "reproduce/numbers.hpp"

#include <stdexcept>
#include <string>

#include "armature/config/conversion.hpp"

namespace armature::reproduce {

Numbers Numbers::operator[](std::string_view key) const {
  const config::Node* value = node_->find(key);
  if (!value) throw std::out_of_range(node_->origin().text() + ": no " + std::string{key});
  return Numbers{*value};
}

double Numbers::number() const {
  const auto number = config::to_number(*node_);
  if (!number) {
    throw std::invalid_argument(number.error().origin.text() + ": a number " +
                                number.error().message);
  }
  return *number;
}

Eigen::VectorXd Numbers::numbers() const {
  Eigen::VectorXd result(static_cast<Eigen::Index>(size()));
  for (std::size_t i = 0; i < size(); ++i) {
    result[static_cast<Eigen::Index>(i)] = (*this)[i].number();
  }
  return result;
}

Eigen::VectorXd Numbers::numbers(std::size_t count) const {
  if (size() != count) {
    throw std::invalid_argument(node_->origin().text() + ": " + std::to_string(count) +
                                " numbers are needed, not " + std::to_string(size()));
  }
  return numbers();
}

Eigen::Isometry3d Numbers::transform() const {
  Eigen::Isometry3d result;
  for (std::size_t row = 0; row < 4; ++row) {
    result.matrix().row(static_cast<Eigen::Index>(row)) = (*this)[row].numbers(4);
  }
  return result;
}

}  // namespace armature::reproduce
