// SPDX-License-Identifier: Apache-2.0
// NRRD files: 1. what is written is read again, 2. forms that other programs write, 3. what is
// wrong with a file is told by name.
#include "armature/volume/nrrd.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zlib.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "armature/values/temporary_folder.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

class Nrrd : public testing::Test {
 protected:
  void write(const std::string& header, const std::string& data) const {
    std::ofstream{file_, std::ios::binary} << "NRRD0004\n" << header << "\n" << data;
  }
  std::string refusal() const {
    const auto volume = read_nrrd(file_);
    return volume ? "read" : volume.error().text.substr(file_.string().size() + 4);
  }
  static std::string header(const std::string& type, const std::string& more,
                            const std::string& directions = "(0.5,0,0) (0,0.5,0) (0,0,2)",
                            const std::string& space = "LPS") {
    return "type: " + type + "\ndimension: 3\nspace: " + space +
           "\nsizes: 2 2 2\nspace directions: " + directions +
           "\nspace origin: (10,20,30)\nkinds: domain domain domain\n" + more;
  }
  /// Of 16-bit numbers in the file itself, as most files have them.
  static std::string raw_header(const std::string& more = {},
                                const std::string& directions = "(0.5,0,0) (0,0.5,0) (0,0,2)",
                                const std::string& space = "LPS") {
    return header("short", "endian: little\nencoding: raw\n" + more, directions, space);
  }
  template <class Number>
  static std::string bytes(std::initializer_list<Number> numbers) {
    std::string data(numbers.size() * sizeof(Number), '\0');
    std::memcpy(data.data(), numbers.begin(), data.size());
    return data;
  }
  static std::string gzipped(const std::string& data) {
    std::string out(data.size() + 1000, '\0');
    z_stream stream{};
    deflateInit2(&stream, 6, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(data.data()));
    stream.avail_in = static_cast<uInt>(data.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    deflateEnd(&stream);
    out.resize(out.size() - stream.avail_out);
    return out;
  }

  const TemporaryFolder folder_;
  const fs::path file_ = folder_ / "volume.nrrd";
  const std::string eight_ = bytes<std::int16_t>({1, 2, 3, 4, 5, 6, 7, -8});
};

TEST_F(Nrrd, WhatIsWrittenIsReadAgain) {
  Volume volume{.geometry = {.size = {3, 2, 4}, .spacing = {0.0007, 0.0008, 0.00125}}};
  volume.geometry.direction =
      Eigen::AngleAxisd{0.3, Eigen::Vector3d{1, 2, 3}.normalized()}.toRotationMatrix();
  volume.geometry.origin = {-0.1, 0.02, 0.3};
  for (int i = 0; i < 24; ++i) volume.voxels.push_back(static_cast<std::int16_t>(100 * i - 1000));
  ASSERT_TRUE(write_nrrd(volume, file_));
  const auto read = read_nrrd(file_);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->voxels, volume.voxels);
  EXPECT_EQ(read->geometry.size, volume.geometry.size);
  for (const Eigen::Vector3d& index : {Eigen::Vector3d{0, 0, 0}, Eigen::Vector3d{2, 1, 3}}) {
    EXPECT_LT((read->geometry.point_at(index) - volume.geometry.point_at(index)).norm(), 1e-12);
  }
}

TEST_F(Nrrd, IsReadRawAndCompressedBigAndLittleOfSeveralTypes) {
  write(header("short", "endian: little\nencoding: raw\n"), eight_);
  const auto raw = read_nrrd(file_);
  ASSERT_TRUE(raw) << raw.error().text;
  EXPECT_EQ(raw->voxels, (std::vector<std::int16_t>{1, 2, 3, 4, 5, 6, 7, -8}));
  EXPECT_LT((raw->geometry.origin - Eigen::Vector3d{0.01, 0.02, 0.03}).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(raw->geometry.spacing.z(), 0.002);
  write(header("short", "endian: little\nencoding: gzip\n"), gzipped(eight_));
  EXPECT_EQ(read_nrrd(file_).value().voxels, raw->voxels);
  write(header("float", "endian: little\nencoding: raw\n"),
        bytes<float>({1, 2, 3, 4, 5, 6.4F, 7, -8}));
  EXPECT_EQ(read_nrrd(file_).value().voxels, raw->voxels);
  write(header("int16", "endian: big\nencoding: raw\n"),
        std::string{"\0\1\0\2\0\3\0\4\0\5\0\6\0\7\xff\xf8", 16});
  EXPECT_EQ(read_nrrd(file_).value().voxels, raw->voxels);
}

TEST_F(Nrrd, OfRightAnteriorSuperiorIsTurnedAndAMirroredOneStaysSo) {
  write(raw_header("", "(-0.5,0,0) (0,-0.5,0) (0,0,2)", "right-anterior-superior"), eight_);
  const auto ras = read_nrrd(file_);
  ASSERT_TRUE(ras) << ras.error().text;
  EXPECT_LT((ras->geometry.direction - Eigen::Matrix3d::Identity()).norm(), 1e-15);
  EXPECT_LT((ras->geometry.origin - Eigen::Vector3d{-0.01, -0.02, 0.03}).norm(), 1e-15);
  write(raw_header("", "(-0.5,0,0) (0,0.5,0) (0,0,2)"), eight_);
  EXPECT_LT(read_nrrd(file_).value().geometry.direction.determinant(), 0);
}

TEST_F(Nrrd, ThatIsTruncatedOrHoldsNoNumbersIsRefusedByName) {
  write(raw_header(), eight_.substr(0, 13));
  EXPECT_EQ(refusal(), "it ends after 13 of 16 bytes of voxels: is it truncated?");
  const std::string zip = gzipped(eight_);
  write(header("short", "endian: little\nencoding: gzip\n"), zip.substr(0, zip.size() - 14));
  EXPECT_NE(refusal().find(" bytes: is it truncated?"), std::string::npos) << refusal();
  write(header("short", "endian: little\nencoding: gzip\n"), gzipped(eight_.substr(0, 14)));
  EXPECT_EQ(refusal(), "it ends after 14 of 16 bytes of voxels: is it truncated?");
  write(header("float", "endian: little\nencoding: raw\n"),
        bytes<float>({1, 2, 3, 4, 5, NAN, 7, 8}));
  EXPECT_EQ(refusal(), "voxel (1, 0, 1) is nan, which is no Hounsfield unit");
  write(header("float", "endian: little\nencoding: raw\n"),
        bytes<float>({1, 2, 3, 1e9F, 5, 6, 7, 8}));
  EXPECT_EQ(refusal(), "voxel (1, 1, 0) is 1e+09, which is no Hounsfield unit");
}

TEST_F(Nrrd, WhoseSlicesAreTiltedIsRefusedByName) {
  write(raw_header("", "(0.5,0,0) (0,0.5,0) (0,0.5,2)"), eight_);
  EXPECT_EQ(refusal(), "its slices are tilted by 14.04 degrees against their stack (gantry tilt)");
  write(raw_header("", "(0.5,0,0) (0.1,0.5,0) (0,0,2)"), eight_);
  EXPECT_EQ(refusal(), "its rows and columns are 11.31 degrees off the right angle");
}

TEST_F(Nrrd, ThatIsAnotherThingIsRefusedByName) {
  std::ofstream{file_} << "\x89PNG";
  EXPECT_EQ(refusal(), "it is no NRRD file");
  write(header("block", "encoding: raw\n"), eight_);
  EXPECT_EQ(refusal(), "the type 'block' is not read");
  write(header("short", "endian: little\nencoding: bzip2\n"), eight_);
  EXPECT_EQ(refusal(), "its encoding is 'bzip2'; raw and gzip are read");
  write(raw_header("", "(0.5,0,0) (0,x,0) (0,0,2)"), eight_);
  EXPECT_EQ(refusal(), "it has no three 'space directions'");
  write(raw_header("", "(0.5,0,0) (0,0.5,0) (0,0,2)", "scanner-xyz"), eight_);
  EXPECT_EQ(refusal().substr(0, 29), "its space is 'scanner-xyz', n");
  write(raw_header("data file: voxels.raw\n"), eight_);
  EXPECT_EQ(refusal(), "line 11: its voxels are in another file, which is not read");
  EXPECT_EQ(read_nrrd("/gone.nrrd").error().text,
            "'/gone.nrrd' cannot be read: No such file or directory");
}

/// Of a sound file with one line more.
TEST_F(Nrrd, WithAFieldThatWouldMoveOrScaleItsVoxelsIsRefusedWithTheLine) {
  const auto with = [&](const std::string& line) {
    const bool says_order = line.find("ndian") != std::string::npos;
    write(header("short", line + (says_order ? "" : "\nendian: little") + "\nencoding: raw\n"),
          eight_);
    return refusal();
  };
  EXPECT_EQ(with("byte skip: 8"),
            "line 9: its 'byte skip' is '8'; only voxels that begin right behind the header are "
            "read");
  EXPECT_EQ(with("byteskip: -1"),
            "line 9: its 'byteskip' is '-1'; only voxels that begin right behind the header are "
            "read");
  EXPECT_EQ(with("line skip: 1"),
            "line 9: its 'line skip' is '1'; only voxels that begin right behind the header are "
            "read");
  EXPECT_EQ(with("old max: 3000"),
            "line 9: its 'old max' is '3000'; only voxels that are Hounsfield units themselves "
            "are read");
  EXPECT_EQ(with("space units: \"m\" \"m\" \"m\""),
            "line 9: its 'space units' is '\"m\" \"m\" \"m\"'; three times \"mm\" is read");
  EXPECT_EQ(with("space units: \"mm\" \"mm\""),
            "line 9: its 'space units' is '\"mm\" \"mm\"'; three times \"mm\" is read");
  EXPECT_EQ(with("endian: middle"), "line 9: its 'endian' is 'middle', not big or little");
  for (const char* harmless : {"byte skip: 0", "line skip: 0", "space units: \"mm\" \"mm\" \"mm\"",
                               "Endian: Little", "type:=byte skip: 8", "# byte skip: 8"}) {
    EXPECT_EQ(with(harmless), "read") << harmless;
  }
}

TEST_F(Nrrd, WithALineThatIsNoFieldIsRefusedWithTheLine) {
  for (const std::string line : {"byte skip:100", "byte skip 100", "old min:\t3"}) {
    write(raw_header(line + "\n"), eight_);
    EXPECT_EQ(refusal(), "line 11: '" + line + "' is neither 'field: value' nor 'key:=value'");
  }
  write(raw_header(std::string(1'000'000, 'x') + "\n"), eight_);
  EXPECT_EQ(refusal(), "line 11: '" + std::string(200, 'x') +
                           "...' is neither 'field: value' nor 'key:=value'");
}

TEST_F(Nrrd, OfNumbersOfSeveralBytesWhoseOrderItDoesNotSayIsRefused) {
  write(header("short", "encoding: raw\n"), eight_);
  EXPECT_EQ(refusal(), "its header has no 'endian', and numbers of type 'short' need it");
  write(header("int8", "encoding: raw\n"), "12345678");
  EXPECT_EQ(refusal(), "read");
}

TEST_F(Nrrd, WithMoreVoxelsThanItsSizesSayIsRefused) {
  for (const std::string& more : {std::string(1, '\0'), eight_ + eight_}) {
    write(raw_header(), eight_ + more);
    EXPECT_EQ(refusal(), "more than 16 bytes of voxels follow: are its sizes right?");
    write(header("short", "endian: little\nencoding: gzip\n"), gzipped(eight_ + more));
    EXPECT_EQ(refusal(), "more than 16 bytes of voxels follow: are its sizes right?");
  }
}

TEST_F(Nrrd, WithAFieldTwiceOrAnOriginThatIsNoPlaceIsRefusedWithTheLine) {
  write(raw_header("Space Origin: (0,0,0)\n"), eight_);
  EXPECT_EQ(refusal(),
            "line 11: 'Space Origin' is there twice, in line 7 as well: which one counts?");
  std::string wrong = raw_header();
  wrong.replace(wrong.find("(10,20,30)"), 10, "(10,nan,30)");
  write(wrong, eight_);
  EXPECT_EQ(refusal(), "line 7: its 'space origin' is '(10,nan,30)', which is no place");
  wrong = raw_header();
  wrong.replace(wrong.find("(10,20,30)"), 10, "(10,-1e6,30)");
  write(wrong, eight_);
  EXPECT_EQ(refusal(), "its first voxel is at (10, -1e+06, 30) mm; up to 100 m are read");
}

TEST_F(Nrrd, IsReadAsFarAsItsSizesSayHoweverLongTheFileIs) {
  constexpr std::uintmax_t kLong = std::uintmax_t{20} << 30;  // of a hole: it takes no room
  const auto lengthened = [&](const std::string& beginning) {
    std::ofstream{file_, std::ios::binary} << beginning;
    fs::resize_file(file_, kLong);
    return refusal();
  };
  EXPECT_EQ(lengthened("NRRD0004\n" + raw_header() + "\n" + eight_),
            "more than 16 bytes of voxels follow: are its sizes right?");
  EXPECT_EQ(lengthened(""), "it is no NRRD file");
  EXPECT_EQ(lengthened("NRRD0004\n"), "line 2: its header is longer than 16777216 bytes");
}

TEST_F(Nrrd, OfManySmallPiecesIsReadOnceAndWhole) {
  std::string sizes = header("double", "endian: little\nencoding: gzip\n");
  sizes.replace(sizes.find("2 2 2"), 5, "90 80 70");
  std::string numbers;
  for (int i = 0; i < 90 * 80 * 70; ++i)
    numbers += bytes<double>({static_cast<double>(i % 30'011)});
  write(sizes, gzipped(numbers));
  const auto volume = read_nrrd(file_);
  ASSERT_TRUE(volume) << volume.error().text;
  ASSERT_EQ(volume->voxels.size(), 90U * 80 * 70);
  for (std::size_t i = 0; i < volume->voxels.size(); ++i) {
    ASSERT_EQ(volume->voxels[i], static_cast<int>(i) % 30'011) << i;
  }
}

TEST_F(Nrrd, OfMoreVoxelsThanAreReadIsRefusedBeforeItTakesMemory) {
  std::string many = raw_header();
  many.replace(many.find("2 2 2"), 5, "1024 1024 1024");
  write(many, "");
  EXPECT_EQ(refusal(), "1073741824 voxels are too many; at most 536870912 are read");
}

TEST_F(Nrrd, ThatCannotBeWrittenTellsWhy) {
  const Volume volume{.geometry = {.size = {2, 2, 2}}, .voxels = std::vector<std::int16_t>(8)};
  for (const auto& [file, why] :
       {std::pair{"/nowhere/head.nrrd", "No such file or directory"},
        std::pair{"/usr", "Is a directory"}, std::pair{"/dev/full", "No space left on device"}}) {
    EXPECT_EQ(write_nrrd(volume, file).error().text,
              "'" + std::string{file} + "' cannot be written: " + why);
  }
}

TEST_F(Nrrd, ThatIsADeviceOrAPipeIsRefusedWithoutWaiting) {
  EXPECT_EQ(read_nrrd("/dev/zero").error().text,
            "'/dev/zero' cannot be read: it is a device or a pipe, not a file");
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  EXPECT_EQ(read_nrrd(file_).error().text,
            "'" + file_.string() + "' cannot be read: it is a device or a pipe, not a file");
}

}  // namespace
}  // namespace armature
