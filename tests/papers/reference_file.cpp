// SPDX-License-Identifier: Apache-2.0
#include "reference_file.hpp"

#include <stdexcept>

#include "armature/config/document.hpp"

namespace armature::paper {

Figures Figures::operator[](std::string_view key) const {
  const config::Node* value = node_->find(key);
  if (!value) throw std::out_of_range(node_->origin().text() + ": no " + std::string{key});
  return Figures{*value};
}

double Figures::number() const { return std::stod(node_->text()); }

Eigen::VectorXd Figures::numbers() const {
  Eigen::VectorXd result(static_cast<Eigen::Index>(size()));
  for (std::size_t i = 0; i < size(); ++i) {
    result[static_cast<Eigen::Index>(i)] = (*this)[i].number();
  }
  return result;
}

Eigen::Isometry3d Figures::transform() const {
  Eigen::Isometry3d result;
  for (std::size_t row = 0; row < 4; ++row) {
    result.matrix().row(static_cast<Eigen::Index>(row)) = (*this)[row].numbers();
  }
  return result;
}

Figures dental_lamp() {
  static const config::Node file =
      config::parse_file(ARMATURE_SOURCE_DIR "/tests/data/dental_lamp_reference.yaml");
  return Figures{file};
}

Figures sr1() {
  static const config::Node file =
      config::parse_file(ARMATURE_SOURCE_DIR "/tests/data/sr1_reference.yaml");
  return Figures{file};
}

Figures dental_implant() {
  static const config::Node file =
      config::parse_file(ARMATURE_SOURCE_DIR "/tests/data/dental_implant_reference.yaml");
  return Figures{file};
}

}  // namespace armature::paper
