// SPDX-License-Identifier: Apache-2.0
// 1. Pairs are found by their names, in two folders or one, in the order of the numbers in them.
// 2. Times come from a file, or from a rate. 3. What is wrong is told with the file and the way
// out.
#include "folder_pictures.hpp"

#include <gtest/gtest.h>

#include <string_view>

#include "picture_files_test.hpp"
#include "tests/refusal.hpp"

namespace armature::pictures {
namespace {

class FolderPicturesTest : public testing::Test {
 protected:
  FolderPictures::Options two_folders() const {
    return {.left = files_.path("left"), .right = files_.path("right"), .interval = seconds(0.5)};
  }
  /// "side grey @ time" of every picture.
  static std::vector<std::string> played(FolderPictures& pictures) {
    std::vector<std::string> all;
    while (const auto timed = pictures.next()) {
      const int grey = timed->picture ? timed->picture->pixels.front() : -1;
      all.push_back((timed->side == Side::left ? "left " : "right ") + std::to_string(grey) +
                    " @ " + std::to_string((timed->stamp - Time{}) / std::chrono::milliseconds{1}));
      EXPECT_EQ(timed->published, timed->stamp);
    }
    return all;
  }
  static std::string refusal(const FolderPictures::Options& options) {
    return test::refusal_of([&] { FolderPictures{options}; });
  }
  PictureFolder files_;
};

TEST_F(FolderPicturesTest, PlaysPairsOfTwoFoldersInTheOrderOfTheirNumbers) {
  for (const auto& [name, grey] :
       {std::pair{"img2.png", 20}, {"img10.png", 100}, {"img1.png", 10}}) {
    files_.write(std::string{"left/"} + name, grey);
    files_.write(std::string{"right/"} + name, grey + 1);
  }
  files_.write_text("left/notes.txt", "no picture");
  FolderPictures pictures{two_folders()};
  const std::vector<std::string> expected{"left 10 @ 0",    "right 11 @ 0",    "left 20 @ 500",
                                          "right 21 @ 500", "left 100 @ 1000", "right 101 @ 1000"};
  EXPECT_EQ(played(pictures), expected);
  pictures.rewind();
  EXPECT_EQ(played(pictures), expected);
  EXPECT_EQ(pictures.last_interval(), seconds(0.5));
}

TEST_F(FolderPicturesTest, FindsPairsOfOneFolderByTheWordsLeftAndRight) {
  files_.write("left01.png", 10);
  files_.write("right01.png", 11);
  files_.write("other.png", 99);
  FolderPictures pictures{{.left = files_.path(), .right = files_.path(), .interval = seconds(1)}};
  EXPECT_EQ(played(pictures), (std::vector<std::string>{"left 10 @ 0", "right 11 @ 0"}));
}

TEST_F(FolderPicturesTest, TurnsColoursGreyAndKeepsWhatTheSensorHad) {
  std::filesystem::create_directories(files_.path("left"));
  std::filesystem::create_directories(files_.path("right"));
  const cv::Mat green{6, 8, CV_8UC3, cv::Scalar{0, 200, 0}};
  ASSERT_TRUE(cv::imwrite(files_.path("left/a.png"), green));
  ASSERT_TRUE(cv::imwrite(files_.path("right/a.png"), green));
  FolderPictures pictures{two_folders()};
  const auto timed = pictures.next();
  ASSERT_TRUE(timed && timed->picture);
  EXPECT_EQ(timed->picture->width, 8);
  EXPECT_EQ(timed->picture->height, 6);
  EXPECT_NEAR(timed->picture->pixels.at(20), 0.587 * 200, 1) << "the green of ITU-R BT.601";
}

TEST_F(FolderPicturesTest, RefusesAPictureOfSixteenBitsOfWhichItWouldReadTheUpperEight) {
  files_.write("right/a.png", 1);
  std::filesystem::create_directories(files_.path("left"));
  ASSERT_TRUE(cv::imwrite(files_.path("left/a.png"), cv::Mat{6, 8, CV_16UC1, cv::Scalar{4095}}));
  FolderPictures pictures{two_folders()};
  const auto timed = pictures.next();
  ASSERT_TRUE(timed && !timed->picture);
  EXPECT_EQ(timed->picture.error().text,
            files_.path("left/a.png") + ": it has 16 bits a pixel; 8 are read");
}

TEST_F(FolderPicturesTest, TakesTimesFromAFileInTheirOrder) {
  for (const std::string name : {"a.png", "b.png", "c.png"}) {
    files_.write("left/" + name, name[0]);
    files_.write("right/" + name, name[0]);
  }
  files_.write_text("times.txt",
                    "# of the cameras' clock\na.png 1000.25\n\nc.png 1000.5\nb.png 1002\n");
  auto options = two_folders();
  options.timestamps = files_.path("times.txt");
  FolderPictures pictures{options};
  EXPECT_EQ(played(pictures),
            (std::vector<std::string>{"left 97 @ 0", "right 97 @ 0", "left 99 @ 250",
                                      "right 99 @ 250", "left 98 @ 1750", "right 98 @ 1750"}));
  EXPECT_EQ(pictures.last_interval(), seconds(1.5));
}

TEST_F(FolderPicturesTest, NamesTheLineOfAFileOfTimesThatIsWrong) {
  files_.write("left/a.png", 1);
  files_.write("right/a.png", 1);
  auto options = two_folders();
  options.timestamps = files_.path("times.txt");
  EXPECT_EQ(refusal(options), "timestamps: '" + files_.path("times.txt") +
                                  "' cannot be read: No such file or directory");
  for (const auto& [text, told] :
       {std::pair{"a.png soon\n", ":1: 'soon' is no time in seconds; a line is 'NAME SECONDS'"},
        {"\na.png nan\n", ":2: 'nan' is no time in seconds; a line is 'NAME SECONDS'"},
        {"a.png\n", ":1: 'a.png' has not two words; a line is 'NAME SECONDS'"},
        {"a.png 1600000000000000000\n",
         ":1: '1600000000000000000' is beyond 9e+09 s, as nanoseconds would be; a line is 'NAME "
         "SECONDS'"},
        {"a.png -1e300\n",
         ":1: '-1e300' is beyond 9e+09 s, as nanoseconds would be; a line is 'NAME SECONDS'"},
        {"a.png 1\na.png 2\n", ":2: 'a.png' has a time already; a line is 'NAME SECONDS'"},
        {"b.png 1\n", ": has no time for 'a.png'; write a line 'a.png SECONDS'"}}) {
    files_.write_text("times.txt", text);
    EXPECT_EQ(refusal(options), files_.path("times.txt") + told);
  }
  files_.write("left/b.png", 1);
  files_.write("right/b.png", 1);
  files_.write_text("times.txt", "a.png 1\nb.png 1\n");
  EXPECT_EQ(refusal(options),
            files_.path("times.txt") + ": 'a.png' and 'b.png' have the same time");
  files_.write_text("times.txt", "a.png 2100000000\nb.png 2000000000\n");
  EXPECT_EQ(refusal(options), files_.path("times.txt") +
                                  ": 'b.png' and 'a.png' are 1e+08 s apart, more than 1e+06 s; "
                                  "seconds are asked for: are these nanoseconds?");
}

TEST_F(FolderPicturesTest, NamesFoldersWithoutPicturesAndPicturesWithoutAPartner) {
  files_.write("left/a.png", 1);
  EXPECT_NE(refusal(two_folders())
                .find("right: the folder '" + files_.path("right") +
                      "' cannot be read: No such file or directory"),
            std::string::npos)
      << refusal(two_folders());
  files_.write_text("right/notes.txt", "");
  EXPECT_NE(
      refusal(two_folders())
          .find("right: the folder '" + files_.path("right") + "' has no pictures (.png, .jpg,"),
      std::string::npos)
      << refusal(two_folders());
  files_.write("right/b.png", 1);
  EXPECT_EQ(refusal(two_folders()),
            "without a partner on the other side: " + files_.path("left/a.png") + ", " +
                files_.path("right/b.png") +
                "; the names of a pair are the same behind 'left' and 'right'; bad_pictures: skip "
                "leaves them out");
  auto skipping = two_folders();
  skipping.skip = true;
  EXPECT_NE(refusal(skipping).find("and no two files are one"), std::string::npos);
  files_.write("right/a.png", 1);
  FolderPictures pictures{skipping};
  EXPECT_EQ(pictures.files().size(), 1U);
  EXPECT_EQ(pictures.left_out(), 1U);
  EXPECT_EQ(pictures.remark(),
            "without a partner on the other side: " + files_.path("right/b.png"));
}

TEST_F(FolderPicturesTest, TellsAFileThatIsNoPictureWhenItsTurnComes) {
  files_.write("left/a.png", 1);
  files_.write_text("right/a.png", "no PNG");
  FolderPictures pictures{two_folders()};
  ASSERT_TRUE(pictures.next()->picture);
  const auto bad = pictures.next();
  ASSERT_FALSE(bad->picture);
  EXPECT_EQ(bad->picture.error().text,
            files_.path("right/a.png") + ": it is none of PNG, JPEG, PGM, PPM, BMP and TIFF");
}

TEST_F(FolderPicturesTest, RefusesAPictureOfWhichTheRestIsMissingInEveryFormat) {
  // A cut JPEG whose missing rows are filled with grey looks like a picture.
  for (const std::string ending : {".jpg", ".png", ".bmp", ".ppm", ".tif"}) {
    SCOPED_TRACE(ending);
    const std::string name = "left/a" + ending;
    files_.write_stripes(name);
    ASSERT_TRUE(read_picture(files_.path(name)));
    std::filesystem::resize_file(files_.path(name),
                                 std::filesystem::file_size(files_.path(name)) / 3);
    const auto cut = read_picture(files_.path(name));
    ASSERT_FALSE(cut);
    EXPECT_TRUE(cut.error().text.starts_with(files_.path(name) + ": ")) << cut.error().text;
  }
}

TEST_F(FolderPicturesTest, ReadsAJpegWithBytesBehindItsEndAsItWas) {
  files_.write_stripes("left/a.jpg");
  const auto expected = cv::imread(files_.path("left/a.jpg"), cv::IMREAD_GRAYSCALE);
  std::ofstream{files_.path("left/a.jpg"), std::ios::app | std::ios::binary} << "and more";
  const auto read = read_picture(files_.path("left/a.jpg"));
  ASSERT_TRUE(read) << read.error().text;
  ASSERT_EQ(read->width, expected.cols);
  EXPECT_TRUE(std::ranges::equal(read->pixels, std::span{expected.data, expected.total()}));
}

TEST_F(FolderPicturesTest, RefusesTwoFilesOfOneSideWithOneName) {
  for (const char* name : {"left/left0003.png", "left/0003.png", "right/0003.png"}) {
    files_.write(name, 1);
  }
  auto skipping = two_folders();
  skipping.skip = true;
  for (const auto& options : {two_folders(), skipping}) {
    EXPECT_EQ(refusal(options), "left: '0003.png' and 'left0003.png' of the folder '" +
                                    files_.path("left") +
                                    "' are one name behind the word 'left'; take one of them away");
  }
}

TEST_F(FolderPicturesTest, LinksThatLeadNowhereDoNotCount) {
  for (const char* name : {"left/a.png", "right/a.png"}) files_.write(name, 1);
  std::filesystem::create_symlink("round.png", files_.path("left/round.png"));
  std::filesystem::create_symlink("gone.png", files_.path("right/lost.png"));
  const FolderPictures pictures{two_folders()};
  EXPECT_EQ(pictures.files().size(), 1U);
  EXPECT_EQ(pictures.left_out(), 0U);
}

TEST_F(FolderPicturesTest, RefusesAPictureWithTooManyPixelsBeforeItUnpacksItInEveryFormat) {
  // Nothing follows, so a decoder would say that it cannot be read.
  using namespace std::string_view_literals;
  for (const std::string_view beginning :
       {"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x75\x30\0\0\x75\x30"sv,
        "BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x30\x75\0\0\x30\x75\0\0"sv,
        "II*\0\x08\0\0\0\2\0\0\1\4\0\1\0\0\0\x30\x75\0\0\1\1\3\0\1\0\0\0\x30\x75\0\0"sv,
        "MM\0*\0\0\0\x08\0\2\1\0\0\4\0\0\0\1\0\0\x75\x30\1\1\0\3\0\0\0\1\x75\x30\0\0"sv,
        "P5 30000 30000 255\n"sv, "P6\n# of a camera\n30000 30000\n255\n"sv}) {
    const auto picture =
        decode_picture({reinterpret_cast<const std::uint8_t*>(beginning.data()), beginning.size()});
    ASSERT_FALSE(picture);
    EXPECT_EQ(picture.error().text, "it has 30000 x 30000 pixels; a side may have 16384")
        << beginning.substr(0, 4);
  }
}

TEST_F(FolderPicturesTest, RefusesAPictureWithTooManyPixelsByItsName) {
  files_.write_text("left/a.pgm", "P5 16000 16000 255\n");
  const auto read = read_picture(files_.path("left/a.pgm"));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().text, files_.path("left/a.pgm") +
                                   ": it has 16000 x 16000 pixels; a picture may have 100 million");
}

TEST_F(FolderPicturesTest, RefusesAFormatOfWhichItDoesNotKnowHowLargeItUnpacks) {
  files_.write_text("left/a.png", "RIFF    WEBPVP8X");
  EXPECT_EQ(read_picture(files_.path("left/a.png")).error().text,
            files_.path("left/a.png") + ": it is none of PNG, JPEG, PGM, PPM, BMP and TIFF");
}

TEST_F(FolderPicturesTest, RefusesAFileOfTooManyBytesAndOneThatIsNoneWithoutReadingIt) {
  files_.write("left/a.bmp", 1);
  std::filesystem::resize_file(files_.path("left/a.bmp"), std::uintmax_t{20} << 30);  // a hole
  EXPECT_EQ(read_picture(files_.path("left/a.bmp")).error().text,
            files_.path("left/a.bmp") +
                ": cannot be read: it has 21474836480 bytes; at most 420000000 are read");
  EXPECT_EQ(read_picture("/dev/zero").error().text,
            "/dev/zero: cannot be read: it is a device or a pipe, not a file");
}

TEST_F(FolderPicturesTest, QuotesTheBeginningOfAWrongLineOfTimesAndReadsNoEndlessOne) {
  files_.write("left/a.png", 1);
  files_.write("right/a.png", 1);
  auto options = two_folders();
  options.timestamps = files_.path("times.txt");
  files_.write_text("times.txt", "\x1b[2J " + std::string(1000, 'x') + " y\n");
  const std::string told = refusal(options);
  EXPECT_LT(told.size(), 300U) << told;
  EXPECT_EQ(told.find('\x1b'), std::string::npos) << told;
  std::filesystem::resize_file(options.timestamps, std::uintmax_t{20} << 30);
  EXPECT_EQ(refusal(options),
            "timestamps: '" + files_.path("times.txt") +
                "' cannot be read: it has 21474836480 bytes; at most 67108864 are read");
}

}  // namespace
}  // namespace armature::pictures
