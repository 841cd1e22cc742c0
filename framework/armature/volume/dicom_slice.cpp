// SPDX-License-Identifier: Apache-2.0
#include "dcmtk/config/osconfig.h"
//
#include "dcmtk/dcmdata/dctk.h"
//
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "armature/values/utf8.hpp"
#include "armature/volume/dicom_slice.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

/// What a slice says, by tag; the first one that is missing or says nothing is remembered.
class Tags {
 public:
  explicit Tags(DcmDataset& data) : data_{data} {}

  std::string text(const DcmTagKey& tag, const char* name) {
    OFString value;
    if (data_.findAndGetOFStringArray(tag, value).bad()) miss(name);
    return value.c_str();
  }
  int integer(const DcmTagKey& tag, const char* name) {
    Uint16 value = 0;
    if (data_.findAndGetUint16(tag, value).bad()) miss(name);
    return value;
  }
  double number(const DcmTagKey& tag, unsigned long at, const char* name) {
    const auto value = optional_number(tag, at, name);
    if (!value) miss(name);
    return value.value_or(0);
  }
  /// Read here: DCMTK takes "1,5" for 1.
  std::optional<double> optional_number(const DcmTagKey& tag, unsigned long at, const char* name) {
    OFString written;
    if (data_.findAndGetOFString(tag, written, at).bad() || written.empty()) return std::nullopt;
    const std::string text = legible(written.c_str());
    const std::string_view digits = std::string_view{text}.substr(text.starts_with('+') ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value)) {
      tell(fmt::format("its {} is '{}', which is no number", name, text));
    }
    return value;
  }
  Vector3d vector(const DcmTagKey& tag, unsigned long at, const char* name) {
    return {number(tag, at, name), number(tag, at + 1, name), number(tag, at + 2, name)};
  }
  const std::string& problem() const { return problem_; }

 private:
  void miss(const char* name) { tell(fmt::format("it has no {}", name)); }
  void tell(std::string problem) {
    if (problem_.empty()) problem_ = std::move(problem);
  }

  DcmDataset& data_;
  std::string problem_;
};

/// What becomes of a pixel's 16 bits, and how many of them are its number (DICOM PS3.5,
/// section 8.1.1).
struct PixelFormat {
  int bits_stored = 16;
  bool is_signed = false;  // two's complement
  double slope = 1, intercept = 0;

  /// Bits above the stored ones are left out: old files keep overlays there.
  double hounsfield(std::uint16_t pixel) const {
    const int unused = 16 - bits_stored;
    const auto raised = static_cast<std::uint16_t>(pixel << unused);
    const int stored = is_signed ? static_cast<std::int16_t>(raised) >> unused : raised >> unused;
    return slope * stored + intercept;
  }
};

Expected<PixelFormat> pixel_format_of(Tags& tags) {
  const PixelFormat format{
      .bits_stored = tags.integer(DCM_BitsStored, "Bits Stored"),
      .is_signed = tags.integer(DCM_PixelRepresentation, "Pixel Representation") == 1,
      .slope = tags.number(DCM_RescaleSlope, 0, "Rescale Slope"),
      .intercept = tags.number(DCM_RescaleIntercept, 0, "Rescale Intercept")};
  const int allocated = tags.integer(DCM_BitsAllocated, "Bits Allocated");
  const int high = tags.integer(DCM_HighBit, "High Bit");
  if (!tags.problem().empty()) return refuse(tags.problem());
  if (format.slope == 0) return refuse("its Rescale Slope is 0: all its pixels would be alike");
  if (allocated != 16) {
    return refuse(fmt::format("it has {} bits a pixel; 16 are read", allocated));
  }
  if (format.bits_stored < 1 || format.bits_stored > allocated) {
    return refuse(fmt::format("its Bits Stored is {}; 1 to 16 are read", format.bits_stored));
  }
  if (high != format.bits_stored - 1) {
    return refuse(fmt::format("its High Bit is {}; of {} Bits Stored it must be {}", high,
                              format.bits_stored, format.bits_stored - 1));
  }
  return format;
}

Expected<void> read_pixels(DcmDataset& data, const PixelFormat& format, DicomSlice& slice) {
  const std::size_t needed =
      static_cast<std::size_t>(slice.rows) * static_cast<std::size_t>(slice.columns);
  const Uint16* pixels = nullptr;
  unsigned long count = 0;
  if (data.findAndGetUint16Array(DCM_PixelData, pixels, &count).bad() || pixels == nullptr ||
      count < needed) {
    return refuse(fmt::format("it has {} of {} pixels: is it truncated?", count, needed));
  }
  slice.hounsfield.resize(needed);
  for (std::size_t i = 0; i < needed; ++i) {
    const double value = format.hounsfield(pixels[i]);
    if (!(std::abs(value) <= 32767)) {
      return refuse(fmt::format("pixel {} is {:g}, which is no Hounsfield unit", i, value));
    }
    slice.hounsfield[i] = static_cast<std::int16_t>(std::lround(value));
  }
  return {};
}

/// Why the pixels are more than those of one slice, of which only the first ones would be read.
std::optional<std::string> several_planes(DcmDataset& data) {
  Sint32 frames = 0;
  if (data.findAndGetSint32(DCM_NumberOfFrames, frames).good() && frames != 1) {
    return fmt::format("it has {} frames; files of one slice each are read", frames);
  }
  Uint16 samples = 0;
  if (data.findAndGetUint16(DCM_SamplesPerPixel, samples).good() && samples != 1) {
    return fmt::format("it has {} numbers a pixel, as colours have; 1 is read", samples);
  }
  return std::nullopt;
}

Expected<DicomSlice> slice_of(DcmDataset& data) {
  Tags tags{data};
  const std::string modality = tags.text(DCM_Modality, "Modality");
  if (tags.problem().empty() && modality != "CT") {
    return refuse(fmt::format("its modality is '{}', not 'CT'", legible(modality)));
  }
  const DcmXfer syntax{data.getOriginalXfer()};
  if (syntax.isEncapsulated()) {
    return refuse(fmt::format("it is compressed ({})", syntax.getXferName()));
  }
  DicomSlice slice;
  slice.series = tags.text(DCM_SeriesInstanceUID, "Series Instance UID");
  slice.rows = tags.integer(DCM_Rows, "Rows");
  slice.columns = tags.integer(DCM_Columns, "Columns");
  slice.position = tags.vector(DCM_ImagePositionPatient, 0, "Image Position (Patient)");
  slice.along_row = tags.vector(DCM_ImageOrientationPatient, 0, "Image Orientation (Patient)");
  slice.along_column = tags.vector(DCM_ImageOrientationPatient, 3, "Image Orientation (Patient)");
  slice.row_step = tags.number(DCM_PixelSpacing, 0, "Pixel Spacing");
  slice.column_step = tags.number(DCM_PixelSpacing, 1, "Pixel Spacing");
  slice.gantry_tilt_deg =
      tags.optional_number(DCM_GantryDetectorTilt, 0, "Gantry/Detector Tilt").value_or(0);
  const auto format = pixel_format_of(tags);
  if (!format) return tl::unexpected{format.error()};
  if (auto wrong = several_planes(data)) return refuse(std::move(*wrong));
  if (!(slice.row_step > 0 && slice.column_step > 0)) {
    return refuse(
        fmt::format("its Pixel Spacing is {:g} and {:g} mm", slice.row_step, slice.column_step));
  }
  for (Vector3d* axis : {&slice.along_row, &slice.along_column}) {
    constexpr double kRounded = 1e-3;  // cosines of three digits are off by that
    if (std::abs(axis->norm() - 1) > kRounded) {
      return refuse(
          fmt::format("an axis of its Image Orientation (Patient) has length {:.4g}, "
                      "not 1",
                      axis->norm()));
    }
    axis->normalize();
  }
  Sint32 slices = 0;
  if (data.findAndGetSint32(DCM_ImagesInAcquisition, slices).good()) slice.of_acquisition = slices;
  if (auto read = read_pixels(data, *format, slice); !read) {
    return tl::unexpected{read.error()};
  }
  return slice;
}

}  // namespace

std::string legible(std::string text) {
  text = in_part(text);
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' ' || c == 0x7F; }, '?');
  return text;
}

Vector3d DicomSlice::normal() const { return along_row.cross(along_column); }

bool is_dicom_image(const std::filesystem::path& file) {
  std::ifstream in{file, std::ios::binary};
  char begin[132] = {};
  in.read(begin, sizeof begin);
  return in.gcount() == sizeof begin && std::string_view{begin + 128, 4} == "DICM" &&
         file.filename() != "DICOMDIR";
}

Expected<DicomSlice> read_dicom_slice(const std::filesystem::path& file) {
  // DCMTK tells its opinion on stderr; what is wrong is told in the reason.
  static const bool quiet = (OFLog::configure(OFLogger::OFF_LOG_LEVEL), true);
  static_cast<void>(quiet);
  constexpr std::uintmax_t kMaxBytes = std::uintmax_t{256} << 20U;
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(file, unknown);
  if (!unknown && bytes > kMaxBytes) {
    return refuse(
        fmt::format("it has {} bytes; a slice with at most {} is read", bytes, kMaxBytes));
  }
  DcmFileFormat format;
  const OFCondition loaded = format.loadFile(file.c_str());
  if (loaded.bad()) {
    return refuse(fmt::format("it cannot be read ({}): is it truncated?", loaded.text()));
  }
  auto slice = slice_of(*format.getDataset());
  if (slice) slice->file = file;
  return slice;
}

}  // namespace armature
