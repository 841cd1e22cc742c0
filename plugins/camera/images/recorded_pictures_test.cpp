// SPDX-License-Identifier: Apache-2.0
// Pictures of a recording: 1. both topics are found by their last words, and every message of them
// is played with its own stamp, once also where two processes have recorded it, 2. what is wrong
// with the file or a message is told.
#include "recorded_pictures.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "armature/messages/header.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/recording/recording_test.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "tests/refusal.hpp"

namespace armature::camera::images {
namespace {

msg::Image grey_image(double stamp_s, std::uint8_t grey) {
  msg::Image image;
  write_header(image.header_(), Time{} + seconds(stamp_s), "camera");
  image.encoding_() = "mono8";
  image.width_() = image.step_() = 4;
  image.height_() = 2;
  image.data_().assign(8, grey);
  return image;
}

class RecordedPicturesTest : public testing::Test {
 protected:
  void write(const std::function<void(McapWriter&)>& fill) {
    McapWriter writer{file_.path(), {}};
    const auto image =
        writer.add(McapSchema{.name = "sensor_msgs/msg/Image", .encoding = "ros2msg", .data = ""});
    const auto text =
        writer.add(McapSchema{.name = "std_msgs/msg/String", .encoding = "ros2msg", .data = ""});
    left_ = channel(writer, image, "/lamp/left/image_raw");
    right_ = channel(writer, image, "/lamp/right/image_raw");
    other_ = channel(writer, text, "/other/left/image_raw");
    fill(writer);
    writer.close();
  }
  static std::uint16_t channel(McapWriter& writer, std::uint16_t schema, const std::string& topic) {
    return writer.add(McapChannel{.schema_id = schema, .topic = topic, .message_encoding = "cdr"});
  }
  void put(McapWriter& writer, std::uint16_t channel, const msg::Image& image, double at_s) {
    std::vector<std::byte> cdr;
    message_type<msg::Image>().encode(&image, cdr);
    const Time at = Time{} + seconds(at_s);
    writer.write(channel, ++sequence_, at + seconds(9), at, cdr);
  }
  /// Three left pictures, each in a chunk of its own; the second one is damaged.
  void write_damaged() {
    write([&](McapWriter& writer) {
      for (const int i : {1, 2, 3}) {
        put(writer, left_, grey_image(i, static_cast<std::uint8_t>(i)), i);
        writer.end_chunk();
      }
    });
    McapReader reader{file_.path()};
    reader.next();
    reader.next();
    damaged_ = reader.chunk();
    constexpr std::size_t kChecksum = 33;  // bytes into a chunk
    std::string bytes = file_.bytes();
    bytes[damaged_ + kChecksum] ^= 1;
    file_.replace(bytes);
  }
  std::string refusal(const std::string& left, const std::string& right) const {
    return test::refusal_of([&] { RecordedPictures{file_.path(), left, right}; });
  }

  RecordingFile file_{"pictures"};
  std::uint16_t left_ = 0, right_ = 0, other_ = 0;
  std::uint32_t sequence_ = 0;
  std::uint64_t damaged_ = 0;  // the chunk at this byte
};

TEST_F(RecordedPicturesTest, PlaysBothTopicsWithTheirOwnTimesAgainAndAgain) {
  write([&](McapWriter& writer) {
    put(writer, left_, grey_image(1.0, 10), 1.03);
    put(writer, other_, grey_image(1.0, 99), 1.03);
    put(writer, right_, grey_image(1.001, 20), 1.04);
    put(writer, left_, grey_image(1.2, 11), 1.23);
  });
  RecordedPictures pictures{file_.path(), "left/image_raw", "/lamp/right/image_raw"};
  for (int round = 0; round < 2; ++round) {
    const auto first = pictures.next(), second = pictures.next(), third = pictures.next();
    ASSERT_TRUE(first && second && third);
    EXPECT_EQ(first->side, pictures::Side::left);
    EXPECT_EQ(first->stamp, Time{} + seconds(1.0));
    EXPECT_EQ(first->published, Time{} + seconds(1.03));
    EXPECT_EQ(first->picture.value().pixels, std::vector<std::uint8_t>(8, 10));
    EXPECT_EQ(second->side, pictures::Side::right);
    EXPECT_EQ(second->stamp, Time{} + seconds(1.001));
    EXPECT_EQ(second->picture.value().pixels.front(), 20);
    EXPECT_EQ(third->picture.value().pixels.front(), 11);
    EXPECT_FALSE(pictures.next());
    EXPECT_EQ(pictures.last_interval(), seconds(0.2));
    EXPECT_EQ(pictures.remark(), "");
    pictures.rewind();
  }
}

TEST_F(RecordedPicturesTest, OfAJoinedRecordingPlaysEachPictureOnce) {
  const auto write_joined = [&](const std::vector<std::string>& processes) {
    write([&](McapWriter& writer) {
      for (const std::string& process : processes) {
        writer.add(McapMetadata{.name = std::string{kProcessMetadata},
                                .values = {{kProcessKey, process}}});
      }
      const std::uint16_t got = writer.add(McapChannel{.schema_id = 1,
                                                       .topic = "/lamp/left/image_raw",
                                                       .message_encoding = "cdr",
                                                       .metadata = {{kFromKey, "main"}}});
      for (const double at : {1.0, 1.1, 1.2}) {
        put(writer, left_, grey_image(at, 10), at);
        put(writer, got, grey_image(at, 10), at);
        put(writer, right_, grey_image(at, 20), at);
        writer.end_chunk();
      }
    });
  };
  const auto played = [&] {
    RecordedPictures pictures{file_.path(), "left/image_raw", "right/image_raw"};
    std::string sides;
    while (const auto picture = pictures.next()) {
      if (picture->picture) sides += picture->side == pictures::Side::left ? 'l' : 'r';
    }
    EXPECT_EQ(pictures.last_interval(), seconds(0.1));
    return sides;
  };
  write_joined({"main", "vision"});
  EXPECT_EQ(played(), "lrlrlr");
  file_.replace(file_.bytes().substr(0, file_.bytes().size() - 8));
  EXPECT_EQ(played(), "lrlrlr") << "cut off: its summary says nothing";
  write_joined({"vision"});
  EXPECT_EQ(played(), "llrllrllr") << "what came from a process that is not in it is all there is";
}

TEST_F(RecordedPicturesTest, NamesTheTopicsThatHavePicturesWhereNoneIsMeant) {
  write([&](McapWriter& writer) { put(writer, left_, grey_image(1, 1), 1); });
  EXPECT_EQ(refusal("left/raw", "right/image_raw"),
            "left_topic: '" + file_.path().string() +
                "' has no pictures of 'left/raw'; those with pictures are /lamp/left/image_raw, "
                "/lamp/right/image_raw");
  EXPECT_NE(refusal("image_raw", "right/image_raw")
                .find("left_topic: 'image_raw' may be any of /lamp/left/image_raw, "
                      "/lamp/right/image_raw in"),
            std::string::npos);
  EXPECT_EQ(refusal("image_raw", "image_raw"), "left_topic and right_topic are both 'image_raw'");
}

TEST_F(RecordedPicturesTest, RefusesAFileThatIsNoRecordingAndPlaysOneThatWasCutOffToItsEnd) {
  file_.replace("no recording");
  EXPECT_NE(refusal("left/image_raw", "right/image_raw").find("recording: "), std::string::npos);
  write([&](McapWriter& writer) {
    put(writer, left_, grey_image(1, 1), 1);
    writer.end_chunk();
    put(writer, right_, grey_image(1, 1), 1);
    writer.end_chunk();
  });
  std::filesystem::resize_file(file_.path(), std::filesystem::file_size(file_.path()) * 2 / 3);
  RecordedPictures pictures{file_.path(), "left/image_raw", "right/image_raw"};
  while (pictures.next()) {
  }
  EXPECT_NE(pictures.remark(), "");
}

TEST_F(RecordedPicturesTest, OfTwoTopicsInACutOffFilePlaysTheFirstAndTellsTheOther) {
  write([&](McapWriter& writer) {
    const std::uint16_t second = channel(writer, 1, "/second/left/image_raw");
    for (const int i : {1, 2}) {
      put(writer, left_, grey_image(i, 10), i);
      put(writer, second, grey_image(i, 99), i);
      put(writer, right_, grey_image(i, 20), i);
      writer.end_chunk();
    }
  });
  file_.replace(file_.bytes().substr(0, file_.bytes().size() - 8));
  RecordedPictures pictures{file_.path(), "left/image_raw", "right/image_raw"};
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(pictures.next()->picture.value().pixels.front(), 10);
    EXPECT_EQ(pictures.next()->picture.error().text,
              file_.path().string() +
                  ": 'left/image_raw' may be /lamp/left/image_raw or /second/left/image_raw; write "
                  "the whole name");
    EXPECT_EQ(pictures.next()->picture.value().pixels.front(), 20);
  }
}

TEST_F(RecordedPicturesTest, LooksThroughAThousandMessagesAtATime) {
  write([&](McapWriter& writer) {
    put(writer, left_, grey_image(1, 1), 1);
    for (int i = 0; i < 2500; ++i) put(writer, other_, grey_image(1, 1), 1);
  });
  RecordedPictures pictures{file_.path(), "left/image_raw", "right/image_raw"};
  EXPECT_TRUE(pictures.next());
  for (const bool has_more : {true, true, false}) {
    EXPECT_FALSE(pictures.next());
    EXPECT_EQ(pictures.has_more(), has_more);
  }
}

TEST_F(RecordedPicturesTest, TellsADamagedChunkWhereItsPicturesAreMissingInEachRound) {
  write_damaged();
  RecordedPictures pictures{file_.path(), "left/image_raw", "right/image_raw"};
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(pictures.next()->picture.value().pixels.front(), 1);
    EXPECT_EQ(pictures.next()->picture.error().text,
              file_.path().string() + ": the chunk at byte " + std::to_string(damaged_) +
                  " has a wrong checksum");
    EXPECT_EQ(pictures.next()->picture.value().pixels.front(), 3);
    EXPECT_EQ(pictures.next()->picture.error().text,
              file_.path().string() + ": the checksum of its messages is wrong: it was changed");
    EXPECT_FALSE(pictures.next());
    EXPECT_FALSE(pictures.next());
    pictures.rewind();
  }
}

TEST_F(RecordedPicturesTest, ADamagedRecordingEndsTheRunWithItsNameOrIsCounted) {
  write_damaged();
  const auto play = [&](const std::string& more) {
    ComponentHarness images{
        built_plugins(),
        {.component = "{plugin: camera/images, params: {recording: " + file_.path().string() +
                      ", left_topic: left/image_raw, right_topic: "
                      "right/image_raw" +
                      more + "}}",
         .robot = {}}};
    for (int i = 0; i < 40; ++i) images.step(0.1 * i);
    return images.figures();
  };
  for (const std::string at_end : {"", ", at_end: loop", ", at_end: end_run"}) {
    const auto refused = play(at_end);
    EXPECT_EQ(refused.status, "refused") << at_end;
    EXPECT_NE(refused.reason.find(" has a wrong checksum; bad_pictures: skip leaves"),
              std::string::npos)
        << refused.reason;
    EXPECT_EQ(refused.metrics.at("pictures"), 1);
  }
  const auto played = play(", bad_pictures: skip");
  EXPECT_EQ(played.status, "");
  EXPECT_EQ(played.metrics.at("pictures"), 2);
  EXPECT_EQ(played.metrics.at("pictures_skipped"), 2) << "the chunk, and the file that has it";
}

TEST_F(RecordedPicturesTest, TellsAMessageThatIsNoPictureItCanRead) {
  write([&](McapWriter& writer) {
    msg::Image depth = grey_image(1, 1);
    depth.encoding_() = "16UC1";
    put(writer, left_, depth, 1);
    msg::Image cut = grey_image(2, 1);
    cut.data_().pop_back();
    put(writer, left_, cut, 2);
  });
  RecordedPictures pictures{file_.path(), "left/image_raw", "right/image_raw"};
  EXPECT_EQ(pictures.next()->picture.error().text,
            file_.path().string() +
                ": the picture of /lamp/left/image_raw that was published at 1.000000 s: it is "
                "'16UC1', which is none of mono8, rgb8, bgr8, rgba8, bgra8");
  EXPECT_NE(pictures.next()->picture.error().text.find("it has 4 x 2 pixels and 7 bytes, 4 a row"),
            std::string::npos);
}

}  // namespace
}  // namespace armature::camera::images
