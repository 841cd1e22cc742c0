// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/dicom_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "armature/volume/dicom_slice.hpp"
#include "armature/volume/slice_stack.hpp"
#include "armature/volume/volume_axes.hpp"

namespace armature {

namespace fs = std::filesystem;

Expected<Volume> read_dicom_series(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry{folder, error}; !error && entry != fs::directory_iterator{};
       entry.increment(error)) {
    std::error_code none;  // a link that leads nowhere is no slice
    if (entry->is_regular_file(none) && is_dicom_image(entry->path())) {
      files.push_back(entry->path());
    }
  }
  if (error) return refuse(fmt::format("'{}': {}", folder.string(), error.message()));
  if (files.empty()) return refuse(fmt::format("'{}': it holds no DICOM files", folder.string()));
  std::ranges::sort(files);
  std::vector<DicomSlice> slices;
  std::size_t voxels = 0;
  for (const fs::path& file : files) {
    auto slice = read_dicom_slice(file);
    if (!slice) return refuse(fmt::format("'{}': {}", file.string(), slice.error().text));
    voxels += slice->hounsfield.size();
    if (auto wrong = too_many_voxels(voxels)) {
      return refuse(fmt::format("'{}': {}", folder.string(), *wrong));
    }
    slices.push_back(std::move(*slice));
  }
  auto volume = stacked(std::move(slices));
  if (!volume) return refuse(fmt::format("'{}': {}", folder.string(), volume.error().text));
  return volume;
}

}  // namespace armature
