// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "armature/values/expected.hpp"

namespace armature {

/// One slice as its file has it; lengths in millimetres, as DICOM.
struct DicomSlice {
  std::filesystem::path file;
  std::string series;  // Series Instance UID
  int rows = 0, columns = 0;
  Eigen::Vector3d position;                 // of the first pixel's centre
  Eigen::Vector3d along_row, along_column;  // unit, to the next column and to the next row
  double column_step = 0, row_step = 0;     // from column to column, from row to row
  double gantry_tilt_deg = 0;               // as the scanner says
  std::optional<int> of_acquisition;     // how many slices the acquisition has, if the file says so
  std::vector<std::int16_t> hounsfield;  // row by row

  Eigen::Vector3d normal() const;
};

/// A text of a file, for a message: in part, without control characters.
std::string legible(std::string text);

/// Whether a file begins as a DICOM file does, and is no DICOMDIR.
bool is_dicom_image(const std::filesystem::path& file);

/// Refuses, without the file's name, what is no slice of computed tomography.
Expected<DicomSlice> read_dicom_slice(const std::filesystem::path& file);

}  // namespace armature
