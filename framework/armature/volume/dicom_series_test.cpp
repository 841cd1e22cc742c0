// SPDX-License-Identifier: Apache-2.0
// DICOM series, written here with DCMTK: 1. the voxels and where they lie, 2. every series that is
// no sound volume is refused by name.
#include "dcmtk/config/osconfig.h"
//
#include "dcmtk/dcmdata/dctk.h"
//
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>

#include "armature/values/temporary_folder.hpp"
#include "armature/volume/dicom_series.hpp"
#include "armature/volume/phantom.hpp"
#include "armature/volume/read_volume.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// How the numbers of pixels lie in their 16 bits.
struct PixelBits {
  int stored = 16, high = 15;
  bool is_signed = false;
};

/// A slice of 4 x 3 pixels, whose first pixel is 100 times its number; lengths in millimetres.
struct Slice {
  int number = 0;
  Vector3d position{-10, 20, 5};
  Vector3d along_row{1, 0, 0}, along_column{0, 1, 0};
  std::string series = "1.2.3", modality = "CT";
  std::string spacing = "0.5\\0.75";  // from row to row, from column to column
  std::string gantry_tilt;
  int of_acquisition = 0;
  int columns = 4, rows = 3;
  int frames = 0, samples = 1;  // 0: they are not told
  std::vector<Uint16> pixels;   // none: 100 times its number, counted up
  PixelBits bits;
  std::string slope = "2", intercept = "-1024";
};

class DicomSeries : public testing::Test {
 protected:
  static std::string numbers(const Vector3d& v) {
    return fmt::format("{:.10g}\\{:.10g}\\{:.10g}", v.x(), v.y(), v.z());
  }
  fs::path write(const Slice& slice, E_TransferSyntax syntax = EXS_LittleEndianExplicit) const {
    DcmFileFormat format;
    DcmDataset& data = *format.getDataset();
    const auto put = [&](const DcmTagKey& tag, const std::string& text) {
      data.putAndInsertString(tag, text.c_str());
    };
    put(DCM_SOPClassUID, UID_CTImageStorage);
    put(DCM_SOPInstanceUID, slice.series + "." + std::to_string(slice.number + 1));
    put(DCM_SeriesInstanceUID, slice.series);
    put(DCM_Modality, slice.modality);
    put(DCM_ImagePositionPatient, numbers(slice.position));
    put(DCM_ImageOrientationPatient, numbers(slice.along_row) + "\\" + numbers(slice.along_column));
    put(DCM_PixelSpacing, slice.spacing);
    put(DCM_RescaleSlope, slice.slope);
    put(DCM_RescaleIntercept, slice.intercept);
    if (!slice.gantry_tilt.empty()) put(DCM_GantryDetectorTilt, slice.gantry_tilt);
    if (slice.of_acquisition > 0) {
      put(DCM_ImagesInAcquisition, std::to_string(slice.of_acquisition));
    }
    const auto number = [&](const DcmTagKey& tag, int value) {
      data.putAndInsertUint16(tag, static_cast<Uint16>(value));
    };
    number(DCM_Rows, slice.rows);
    number(DCM_Columns, slice.columns);
    number(DCM_BitsAllocated, 16);
    number(DCM_BitsStored, slice.bits.stored);
    number(DCM_HighBit, slice.bits.high);
    number(DCM_PixelRepresentation, slice.bits.is_signed ? 1 : 0);
    number(DCM_SamplesPerPixel, slice.samples);
    if (slice.frames > 0) put(DCM_NumberOfFrames, std::to_string(slice.frames));
    std::vector<Uint16> pixels = slice.pixels;
    for (int i = 0; pixels.size() < 12; ++i) {
      pixels.push_back(static_cast<Uint16>(100 * slice.number + i));
    }
    data.putAndInsertUint16Array(DCM_PixelData, pixels.data(),
                                 static_cast<unsigned long>(pixels.size()));
    const fs::path file = folder_ / fmt::format("slice{:02}.dcm", slice.number);
    EXPECT_TRUE(format.saveFile(file.c_str(), syntax).good());
    return file;
  }
  /// `count` slices, 1.25 mm apart along their normal.
  void write_series(int count, const Slice& like = {}) const {
    for (int i = 0; i < count; ++i) write(at(i, 1.25 * i, like));
  }
  static Slice at(int number, double along_normal, Slice like = {}) {
    like.position += along_normal * like.along_row.cross(like.along_column);
    like.number = number;
    return like;
  }
  std::string refusal() const {
    const auto volume = read_volume(folder_.path());
    if (volume) return "read";
    return volume.error().text.substr(folder_.path().string().size() + 1);
  }

  const TemporaryFolder folder_;
};

TEST_F(DicomSeries, IsReadInTheOrderOfItsPlacesWhateverItsNames) {
  for (const int i : {0, 1, 2, 3}) write(at(3 - i, 1.25 * i));
  std::ofstream{folder_ / "README"} << "no DICOM";
  const auto volume = read_volume(folder_.path());
  ASSERT_TRUE(volume) << volume.error().text;
  EXPECT_EQ(volume->geometry.size, (std::array{4, 3, 4}));
  EXPECT_LT((volume->geometry.spacing - Vector3d{0.00075, 0.0005, 0.00125}).norm(), 1e-12);
  EXPECT_LT((volume->geometry.origin - Vector3d{-0.010, 0.020, 0.005}).norm(), 1e-12);
  EXPECT_LT((volume->geometry.direction - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_EQ(volume->at(0, 0, 0), 2 * 300 - 1024);
  EXPECT_EQ(volume->at(1, 2, 3), 2 * (0 + 9) - 1024);
}

TEST_F(DicomSeries, MayLieAnyhowInThePatientAndInEveryUncompressedForm) {
  Slice turned;
  const Eigen::Matrix3d rotation{
      Eigen::AngleAxisd{0.3, Vector3d{1, 2, -1}.normalized()}.toRotationMatrix()};
  turned.along_row = rotation.col(0);
  turned.along_column = rotation.col(1);
  for (const auto syntax :
       {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit, EXS_BigEndianExplicit}) {
    for (int i = 0; i < 3; ++i) write(at(i, 1.25 * i, turned), syntax);
    const auto volume = read_volume(folder_.path());
    ASSERT_TRUE(volume) << volume.error().text;
    EXPECT_LT((volume->geometry.direction - rotation).norm(), 1e-8);
    EXPECT_EQ(volume->at(3, 0, 2), 2 * 203 - 1024);
  }
}

TEST_F(DicomSeries, WhoseOrientationIsRoundedHasTheSizeThatItsSpacingSays) {
  Slice slice;
  slice.along_row = {0.707, 0.707, 0};
  slice.along_column = {-0.707, 0.707, 0};
  for (int i = 0; i < 3; ++i) {
    slice.number = i;
    slice.position.z() = 5 + 1.25 * i;
    write(slice);
  }
  const auto volume = read_volume(folder_.path());
  ASSERT_TRUE(volume) << volume.error().text;
  EXPECT_LT((volume->geometry.spacing - Vector3d{0.00075, 0.0005, 0.00125}).norm(), 1e-12);
  slice.along_row = {0.7, 0.7, 0};
  write(slice);
  EXPECT_EQ(refusal(),
            "/slice02.dcm': an axis of its Image Orientation (Patient) has length 0.9899, not 1");
}

TEST_F(DicomSeries, OfAHeadIsTheVolumeThatItWasWrittenFrom) {
  VolumeGeometry geometry{.size = {20, 18, 16}, .spacing = {0.00075, 0.0005, 0.00125}};
  geometry.origin = {-0.01, 0.02, 0.005};
  const Volume head = scanned(std::array{ball({-0.003, 0.024, 0.015}, 0.004, 1000)}, geometry, {});
  for (int k = 0; k < 16; ++k) {
    Slice slice = at(k, 1.25 * k);
    slice.columns = 20;
    slice.rows = 18;
    for (int i = 0; i < 20 * 18; ++i) {
      const auto hu = head.voxels[static_cast<std::size_t>(20 * 18 * k + i)];
      slice.pixels.push_back(static_cast<Uint16>((hu + 1024) / 2));
    }
    write(slice);
  }
  const auto volume = read_volume(folder_.path());
  ASSERT_TRUE(volume) << volume.error().text;
  for (std::size_t i = 0; i < head.voxels.size(); ++i) {
    ASSERT_NEAR(volume->voxels[i], head.voxels[i], 1) << i;  // a step of the file is two
  }
  EXPECT_NEAR(hounsfield_at(*volume, {-0.003, 0.024, 0.015}), 1000, 1);
}

TEST_F(DicomSeries, OfTwelveSignedBitsHasAirBelowAndBoneAboveZero) {
  Slice slice;
  slice.bits = {.stored = 12, .high = 11, .is_signed = true};
  slice.slope = "1";
  slice.intercept = "0";
  slice.pixels = {0x0C18, 0x0FFF, 0x0800, 0x07FF, 0x0000, 0x0001};  // two's complement of 12 bits
  write_series(3, slice);
  const auto volume = read_volume(folder_.path());
  ASSERT_TRUE(volume) << volume.error().text;
  EXPECT_EQ(std::vector<std::int16_t>(volume->voxels.begin(), volume->voxels.begin() + 6),
            (std::vector<std::int16_t>{-1000, -1, -2048, 2047, 0, 1}));
}

TEST_F(DicomSeries, WithAnOverlayInTheUnusedBitsHasTheDensitiesOfTheOthers) {
  Slice slice;
  slice.bits = {.stored = 12, .high = 11};
  slice.slope = "1";
  slice.pixels = {0x1000 | 24, 0x8000 | 1024, 0x0FFF, 0xF000, 0xFFFF, 7};
  write_series(3, slice);
  const auto volume = read_volume(folder_.path());
  ASSERT_TRUE(volume) << volume.error().text;
  EXPECT_EQ(std::vector<std::int16_t>(volume->voxels.begin(), volume->voxels.begin() + 6),
            (std::vector<std::int16_t>{-1000, 0, 3071, -1024, 3071, -1017}));
  slice.bits.is_signed = true;
  write_series(3, slice);
  EXPECT_EQ(read_volume(folder_.path())->at(2, 0, 0), -1025)
      << "signed: all bits above are its sign";
}

TEST_F(DicomSeries, WhosePixelsAreNotInTheLowestBitsIsRefused) {
  Slice slice;
  slice.bits = {.stored = 12, .high = 15};
  write_series(3, slice);
  EXPECT_EQ(refusal(), "/slice00.dcm': its High Bit is 15; of 12 Bits Stored it must be 11");
  slice.bits = {.stored = 17, .high = 16};
  write_series(3, slice);
  EXPECT_EQ(refusal(), "/slice00.dcm': its Bits Stored is 17; 1 to 16 are read");
  slice.bits = {.stored = 0, .high = 0};
  write_series(3, slice);
  EXPECT_EQ(refusal(), "/slice00.dcm': its Bits Stored is 0; 1 to 16 are read");
}

TEST_F(DicomSeries, OfATiltedGantryIsRefused) {
  for (int i = 0; i < 4; ++i) {
    Slice slice = at(i, 1.25 * i);
    slice.position.y() += 0.3 * i;
    write(slice);
  }
  EXPECT_EQ(refusal(),
            "': its slices are tilted by 13.50 degrees against their stack (gantry tilt)");
  Slice corrected;
  corrected.gantry_tilt = "13.5";
  write_series(4, corrected);
  EXPECT_EQ(refusal(), "': its gantry was tilted by 13.5 degrees (gantry tilt)");
  corrected.gantry_tilt = "0,5";
  write_series(4, corrected);
  EXPECT_THAT(refusal(),
              testing::HasSubstr("its Gantry/Detector Tilt is '0,5', which is no number"));
}

TEST_F(DicomSeries, WithMissingSlicesIsRefused) {
  for (const int i : {0, 1, 2, 5, 6, 7}) write(at(i, 1.25 * i));
  EXPECT_EQ(refusal(), "': 2 slices are missing between 'slice02.dcm' and 'slice05.dcm'");
}

TEST_F(DicomSeries, WhoseLastSlicesAreMissingIsRefusedWhenTheFilesTell) {
  Slice slice;
  slice.of_acquisition = 6;
  write_series(4, slice);
  EXPECT_EQ(refusal(), "': it has 4 slices of an acquisition of 6");
}

TEST_F(DicomSeries, OfUnequalSpacingIsRefused) {
  for (int i = 0; i < 6; ++i) write(at(i, 1.25 * i + (i > 3 ? 0.4 : 0)));
  EXPECT_EQ(refusal(),
            "': the slices are unequally spaced: 1.65 mm between 'slice03.dcm' and 'slice04.dcm', "
            "1.25 mm elsewhere");
}

TEST_F(DicomSeries, WithASliceThatIsPushedAsideIsRefused) {
  write_series(5);
  Slice aside = at(2, 2.5);
  aside.position.x() += 30;
  write(aside);
  EXPECT_EQ(refusal(),
            "': 'slice02.dcm' lies 30 mm beside its place in the row from 'slice00.dcm' to "
            "'slice04.dcm'; up to 0.025 mm are taken");
  aside.position.x() += 0.02 - 30;
  write(aside);
  EXPECT_EQ(refusal(), "read") << "as positions are rounded";
}

TEST_F(DicomSeries, WhoseStepsShrinkSlowlyIsRefused) {
  double along_normal = 0;
  for (int i = 0; i < 20; ++i) {
    write(at(i, along_normal));
    along_normal += i < 10 ? 1.26 : 1.24;  // each is within 2 % of 1.25
  }
  EXPECT_EQ(refusal(),
            "': 'slice10.dcm' lies 0.0947 mm beside its place in the row from 'slice00.dcm' to "
            "'slice19.dcm'; up to 0.025 mm are taken");
}

TEST_F(DicomSeries, WithTwoSlicesOfOnePlaceIsRefused) {
  write_series(4);
  write(at(4, 2.5));
  EXPECT_EQ(refusal(), "': 'slice02.dcm' and 'slice04.dcm' are slices of the same place");
}

TEST_F(DicomSeries, MixedWithAnotherIsRefused) {
  write_series(4);
  Slice other = at(4, 5);
  other.series = "1.2.4";
  write(other);
  EXPECT_EQ(refusal(), "': 2 series are mixed: 1.2.3 (4 files) 1.2.4 (1 files)");
}

TEST_F(DicomSeries, OfSlicesThatAreNotAlikeIsRefused) {
  write_series(4);
  Slice coarse = at(2, 2.5);
  coarse.spacing = "0.5\\0.8";
  write(coarse);
  EXPECT_EQ(refusal(), "': the pixel spacings of 'slice00.dcm' and 'slice02.dcm' differ");
  Slice turned = at(2, 2.5);
  turned.along_row = {0, 1, 0};
  turned.along_column = {-1, 0, 0};
  write(turned);
  EXPECT_EQ(refusal(), "': the orientations of 'slice00.dcm' and 'slice02.dcm' differ");
}

TEST_F(DicomSeries, OfAnotherModalityIsRefused) {
  Slice mr;
  mr.modality = "MR";
  write_series(3, mr);
  EXPECT_EQ(refusal(), "/slice00.dcm': its modality is 'MR', not 'CT'");
}

TEST_F(DicomSeries, WithANumberThatIsNoneIsRefusedAndNotReadUpToItsComma) {
  Slice slice;
  slice.spacing = "1,25\\1,25";
  write_series(3, slice);
  EXPECT_EQ(refusal(), "/slice00.dcm': its Pixel Spacing is '1,25', which is no number");
  for (const std::string slope : {"1,5", "0x10", "nan", "inf", "1 2", "steep"}) {
    slice = {.slope = slope};
    write_series(3, slice);
    EXPECT_EQ(refusal(), "/slice00.dcm': its Rescale Slope is '" + slope + "', which is no number");
  }
  slice = {.slope = ""};
  write_series(3, slice);
  EXPECT_EQ(refusal(), "/slice00.dcm': it has no Rescale Slope");
  slice = {.slope = "+2.0E0 ", .intercept = " -1024 "};
  write_series(3, slice);
  EXPECT_EQ(refusal(), "read");
}

TEST_F(DicomSeries, WhosePixelsWouldBeAlikeOrMirroredIsRefused) {
  write_series(3, {.slope = "0"});
  EXPECT_EQ(refusal(), "/slice00.dcm': its Rescale Slope is 0: all its pixels would be alike");
  write_series(3, {.spacing = "-0.5\\0.75"});
  EXPECT_EQ(refusal(), "/slice00.dcm': its Pixel Spacing is -0.5 and 0.75 mm");
}

TEST_F(DicomSeries, OfSeveralFramesOrColoursIsRefusedAndNotReadInPart) {
  std::vector<Uint16> pixels(36, 1000);
  write_series(3, {.frames = 3, .pixels = pixels});
  EXPECT_EQ(refusal(), "/slice00.dcm': it has 3 frames; files of one slice each are read");
  write_series(3, {.samples = 3, .pixels = pixels});
  EXPECT_EQ(refusal(), "/slice00.dcm': it has 3 numbers a pixel, as colours have; 1 is read");
  write_series(3, {.frames = 1});
  EXPECT_EQ(refusal(), "read");
}

TEST_F(DicomSeries, FarFromEveryTomographIsRefused) {
  write_series(3, {.position = {2e6, 0, 0}});
  EXPECT_EQ(refusal(), "': its first voxel is at (2e+06, 0, 0) mm; up to 100 m are read");
}

TEST_F(DicomSeries, OfALongFileIsRefusedBeforeItIsRead) {
  write_series(3);
  fs::resize_file(folder_ / "slice01.dcm", std::uintmax_t{20} << 30);  // a hole: it takes no room
  EXPECT_EQ(refusal(),
            "/slice01.dcm': it has 21474836480 bytes; a slice with at most 268435456 is read");
}

TEST_F(DicomSeries, OfManyMixedOnesTellsTheFirstWithWhatATerminalShows) {
  for (int i = 0; i < 8; ++i) {
    Slice slice = at(i, 1.25 * i);
    slice.series = fmt::format("{}\x1b[31m{}", i, std::string(230, '1'));
    write(slice);
  }
  const std::string first = "?[31m" + std::string(194, '1') + "... (1 files)";
  EXPECT_EQ(refusal(), "': 8 series are mixed: 0" + first + " 1" + first + " 2" + first + " 3" +
                           first + " 4" + first + " and 3 more");
}

TEST_F(DicomSeries, WithATruncatedFileIsRefusedByItsName) {
  write_series(3);
  const fs::path file = folder_ / "slice01.dcm";
  const auto size = fs::file_size(file);
  for (const auto cut : {1U, 10U, 24U, 60U, 300U}) {
    fs::resize_file(file, size - cut);
    const std::string text = refusal();
    EXPECT_EQ(text.find("/slice01.dcm': it "), 0u) << cut << ": " << text;
    EXPECT_TRUE(cut > 30 || text.find("truncated?") != std::string::npos) << cut << ": " << text;
  }
}

TEST_F(DicomSeries, IsReadWhateverLinksLeadNowhereBesideItsSlices) {
  write_series(3);
  // A folder is read in an order of its own: with so many, one of them is most likely the last.
  for (int i = 0; i < 64; ++i) {
    fs::create_symlink("nowhere", folder_ / fmt::format("link{}", i));
  }
  EXPECT_EQ(refusal(), "read");
}

TEST_F(DicomSeries, OfAFolderThatCannotBeReadIsRefusedWithTheReason) {
  const auto volume = read_dicom_series(folder_ / "none");
  EXPECT_EQ(volume.error().text,
            "'" + (folder_ / "none").string() + "': No such file or directory");
}

TEST_F(DicomSeries, OfOneSliceOrNoneIsNoVolume) {
  EXPECT_EQ(refusal(), "': it holds no DICOM files");
  write_series(1);
  EXPECT_EQ(refusal(), "': 1 slices are no volume");
}

}  // namespace
}  // namespace armature
