// SPDX-License-Identifier: Apache-2.0
#include "reference_file.hpp"

#include "armature/config/document.hpp"

namespace armature::paper {

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
