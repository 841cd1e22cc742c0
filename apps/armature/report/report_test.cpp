// SPDX-License-Identifier: Apache-2.0
// A recording goes into a page, and comes out of it again.
#include "report/report.hpp"

#include <gmock/gmock.h>

#include <map>
#include <vector>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/recording_test.hpp"
#include "exit_code.hpp"
#include "report/reduced_recording.hpp"

namespace armature {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr std::string_view kPage =
    "<!doctype html><body><main></main><script type=\"module\">the_page();</script></body>\n";
constexpr std::int64_t kMs = 1'000'000;

std::string decoded(const std::string& base64) {
  static const std::string kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : base64) {
    if (c == '=') break;
    group = group << 6 | static_cast<std::uint32_t>(kDigits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 0xFF);
  }
  return bytes;
}

class ReportTest : public testing::Test {
 protected:
  ReportTest() {
    page_.replace(std::string{kPage});
    std::filesystem::remove(out_.path());
  }

  /// So many messages of a topic, at even distances from 0 ms.
  struct Topic {
    std::string name, type;
    int count = 0;
    std::int64_t period_ms = 1;
  };
  void record(const std::vector<Topic>& topics, const std::string& figures = {}) {
    McapWriter writer{recording_.path(), {}};
    for (const Topic& topic : topics) {
      const auto schema = writer.add(
          McapSchema{.name = topic.type, .encoding = "ros2msg", .data = "string data\n"});
      const auto channel = writer.add(
          McapChannel{.schema_id = schema, .topic = topic.name, .message_encoding = "cdr"});
      for (int i = 0; i < topic.count; ++i) {
        const std::string text = payload(i);
        const Time time{kMs * (1000 + i * topic.period_ms)};
        writer.write(channel, static_cast<std::uint32_t>(i), time, time,
                     std::as_bytes(std::span{text}));
      }
    }
    writer.attach({.name = "lamp.yaml", .media_type = "application/yaml", .data = "armature: 1\n"});
    if (!figures.empty()) {
      writer.attach({.name = "figures.json", .media_type = "application/json", .data = figures});
    }
    writer.add(McapMetadata{.name = "armature.deployment",
                            .values = {{"fingerprint", "</script><b a=\"1\">"}}});
    writer.close();
  }
  int report(bool pictures = true, bool force = false) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    int code = kFailed;
    reason_.clear();
    try {
      code = print_report({.recording = recording_.path(),
                           .out = out_.path(),
                           .page = page_.path(),
                           .pictures = pictures,
                           .force = force});
    } catch (const std::runtime_error& error) {
      reason_ = error.what();
    }
    testing::internal::GetCapturedStdout();
    testing::internal::GetCapturedStderr();
    return code;
  }
  /// The recording in the page, in a file.
  const std::filesystem::path& inside() {
    const std::string html = out_.bytes();
    const std::size_t tag = html.find("id=\"recording\"");
    const std::size_t begin = html.find('>', tag) + 1, end = html.find('<', begin);
    inside_.replace(decoded(html.substr(begin, end - begin)));
    return inside_.path();
  }
  std::map<std::string, int> counts() {
    McapReader reader{inside()};
    std::map<std::string, int> counts;
    while (const auto message = reader.next()) ++counts[message->channel->topic];
    EXPECT_THAT(reader.problems(), testing::IsEmpty());
    return counts;
  }

  RecordingFile recording_{"report-of"}, page_{"page"}, out_{"report"}, inside_{"inside"};
  std::string reason_;
};

TEST_F(ReportTest, SaysOfARepairedRecordingWhatItWasMadeOf) {
  {
    McapWriter writer{recording_.path(), {}};
    write_all_but_the_end(writer, 100);
    writer.add(McapMetadata{.name = "armature.repaired",
                            .values = {{"file", "cut.mcap"}, {"chain", "cut"}}});
    writer.close();
  }
  ASSERT_EQ(report(), kOk) << reason_;
  EXPECT_THAT(out_.bytes(), HasSubstr("it was repaired from 'cut.mcap', which was cut off"));
}

TEST_F(ReportTest, HasTheRecordingInItToTheLastByte) {
  record({{"/a", "std_msgs/msg/String", 100, 100}});
  ASSERT_EQ(report(), kOk) << reason_;
  McapReader there{recording_.path()}, here{inside()};
  int messages = 0;
  while (const auto a = there.next()) {
    const auto b = here.next();
    ASSERT_TRUE(b);
    EXPECT_EQ(a->channel->topic, b->channel->topic);
    EXPECT_EQ(a->sequence, b->sequence);
    EXPECT_EQ(a->log_time, b->log_time);
    EXPECT_TRUE(std::ranges::equal(a->data, b->data));
    ++messages;
  }
  EXPECT_EQ(messages, 100);
  EXPECT_FALSE(here.next());
  ASSERT_EQ(here.attachments().size(), 1U);
  EXPECT_EQ(here.attachments()[0].data, "armature: 1\n");
  EXPECT_EQ(here.metadata().size(), 1U);
}

TEST_F(ReportTest, IsThePageWithOneElementThatNothingBreaksOutOf) {
  record({{"/a", "std_msgs/msg/String", 100, 100}});
  ASSERT_EQ(report(), kOk) << reason_;
  const std::string html = out_.bytes();
  const std::size_t begin = html.find("<script type=\"application/octet-stream;base64\"");
  ASSERT_NE(begin, std::string::npos);
  const std::size_t end = html.find("</script>\n", begin) + 10;
  const std::string element = html.substr(begin, end - begin);
  EXPECT_EQ(html.substr(0, begin) + html.substr(end), kPage);
  EXPECT_EQ(element.find("</script"), element.size() - 10) << "only its own end";
  EXPECT_THAT(element, HasSubstr("&lt;/script&gt;&lt;b a=\\&quot;1\\&quot;&gt;"));
}

TEST_F(ReportTest, TellsWhatItWasMadeOf) {
  record({{"/a", "std_msgs/msg/String", 100, 100}});
  ASSERT_EQ(report(), kOk) << reason_;
  McapReader reader{recording_.path(), true};
  while (reader.next()) continue;
  const std::string html = out_.bytes();
  EXPECT_THAT(html, HasSubstr("data-name=\"" + recording_.path().filename().string() + "\""));
  EXPECT_THAT(html, HasSubstr(reader.chain().head));
  EXPECT_THAT(html, HasSubstr(sha256_of_file(recording_.path())));
  EXPECT_THAT(html, HasSubstr("whole and unchanged"));
  EXPECT_THAT(html, HasSubstr("1970-01-01 00:00:01 UTC, 9.9 s"));
}

TEST_F(ReportTest, KeepsFiftyMessagesASecondAndTwoPictures) {
  record({{"/fast", "sensor_msgs/msg/JointState", 4000, 1},
          {"/slow", "sensor_msgs/msg/JointState", 160, 25},
          {"/tf", "tf2_msgs/msg/TFMessage", 4000, 1},
          {"/activations", "armature_msgs/msg/Activation", 4000, 1},
          {"/left", "sensor_msgs/msg/Image", 40, 100},
          {"/left/compressed", "sensor_msgs/msg/CompressedImage", 40, 100},
          {"/right", "sensor_msgs/msg/Image", 40, 100}});
  ASSERT_EQ(report(), kOk) << reason_;
  const std::map<std::string, int> kept{
      {"/fast", 200 + 10}, {"/slow", 160}, {"/tf", 4000}, {"/left/compressed", 8}, {"/right", 8}};
  EXPECT_EQ(counts(), kept);
  ASSERT_EQ(report(false, true), kOk) << reason_;
  EXPECT_EQ(counts().size(), 3U) << "no pictures";
}

TEST_F(ReportTest, KeepsSoManyOfEachWriterOfATopicThatSeveralShare) {
  record({{"/shared", "std_msgs/msg/String", 200, 5}, {"/shared", "std_msgs/msg/String", 200, 5}});
  ASSERT_EQ(report(), kOk) << reason_;
  McapReader reader{inside()};
  std::map<std::uint16_t, int> by_writer;
  while (const auto message = reader.next()) ++by_writer[message->channel->id];
  ASSERT_EQ(by_writer.size(), 2U);
  EXPECT_EQ(by_writer.begin()->second, by_writer.rbegin()->second);
  EXPECT_GE(by_writer.begin()->second, 50);
}

TEST_F(ReportTest, TellsWhatItsRunHasNotRecorded) {
  {
    McapWriter writer{recording_.path(), {}};
    write_all_but_the_end(writer, 100);
    writer.add(McapMetadata{.name = "armature.end",
                            .values = {{"process", "main"},
                                       {"lost of src", "7"},
                                       {"strays of work", "3"},
                                       {"thinned", "50"}}});
    writer.close();
  }
  ASSERT_EQ(report(), kOk) << reason_;
  EXPECT_THAT(out_.bytes(), HasSubstr("7 calls of 'src' were not recorded"));
  EXPECT_THAT(out_.bytes(), HasSubstr("3 messages of threads of 'work' were not recorded"));
  EXPECT_THAT(out_.bytes(), HasSubstr("of 150 messages"));
}

TEST_F(ReportTest, HasRawPicturesAsJpegWhereThePageLooksForThem) {
  msg::Image image;
  image.header_().frame_id_("right_camera_optical");
  image.encoding_("rgb8");
  image.width_(640);
  image.height_(480);
  image.step_(3 * 640);
  image.data_().resize(std::size_t{480} * 3 * 640);
  for (std::size_t i = 0; i < image.data_().size(); ++i) {
    image.data_()[i] = static_cast<std::uint8_t>(i / 1920 + (i * 2654435761U >> 28 & 7));  // noise
  }
  std::vector<std::byte> cdr;
  message_type<msg::Image>().encode(&image, cdr);
  {
    McapWriter writer{recording_.path(), {}};
    const auto schema = writer.add(
        McapSchema{.name = "sensor_msgs/msg/Image", .encoding = "ros2msg", .data = "uint8 a\n"});
    const auto channel = writer.add(
        McapChannel{.schema_id = schema, .topic = "/right/image_raw", .message_encoding = "cdr"});
    writer.write(channel, 1, Time{kMs}, Time{kMs}, cdr);
    writer.close();
  }
  ASSERT_EQ(report(), kOk) << reason_;
  McapReader reader{inside()};
  const auto message = reader.next();
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel->topic, "/right/image_raw/compressed");
  EXPECT_EQ(reader.schemas().at(message->channel->schema_id).name,
            "sensor_msgs/msg/CompressedImage");
  msg::CompressedImage compressed;
  ASSERT_TRUE(message_type<msg::CompressedImage>().decode(message->data, &compressed));
  EXPECT_EQ(compressed.format_(), "jpeg");
  EXPECT_EQ(compressed.header_().frame_id_(), "right_camera_optical");
  EXPECT_LT(10 * compressed.data_().size(), image.data_().size());
  EXPECT_FALSE(reader.next()) << "no raw one beside it";
}

TEST_F(ReportTest, HasTheFiguresThatTheRunTold) {
  record({{"/a", "std_msgs/msg/String", 100, 100}}, R"({"status":"ok","title":"<b>"})");
  ASSERT_EQ(report(), kOk) << reason_;
  EXPECT_THAT(
      out_.bytes(),
      HasSubstr(
          "data-figures=\"{&quot;status&quot;:&quot;ok&quot;,&quot;title&quot;:&quot;&lt;b&gt;"));
}

TEST_F(ReportTest, ReplacesNothingUnasked) {
  record({{"/a", "std_msgs/msg/String", 100, 100}});
  out_.replace("mine");
  EXPECT_NE(report(), kOk);
  EXPECT_THAT(reason_, HasSubstr("is there already; --force replaces it"));
  EXPECT_EQ(out_.bytes(), "mine");
  EXPECT_EQ(report(true, true), kOk) << reason_;
  EXPECT_THAT(out_.bytes(), StartsWith("<!doctype html>"));
  const std::string before = recording_.bytes();
  EXPECT_THROW(write_report({.recording = recording_.path(),
                             .out = recording_.path(),
                             .page = page_.path(),
                             .force = true}),
               InvalidChoice);
  EXPECT_EQ(recording_.bytes(), before);
}

TEST_F(ReportTest, IsReadByItsOwnerOnly) {
  record({{"/a", "std_msgs/msg/String", 100, 100}});
  ASSERT_EQ(report(), kOk) << reason_;
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(out_.path()).permissions(),
            perms::owner_read | perms::owner_write);
}

TEST_F(ReportTest, RefusesWhatIsNoRecordingAndOneWithoutMessages) {
  recording_.replace("this is no recording");
  EXPECT_NE(report(), kOk);
  EXPECT_THAT(reason_, HasSubstr("no MCAP file"));
  record({});
  EXPECT_NE(report(), kOk);
  EXPECT_THAT(reason_, HasSubstr("has no messages"));
  EXPECT_FALSE(std::filesystem::exists(out_.path()));
}

TEST_F(ReportTest, LeavesOutWhatComesToItsRecordingWhileItIsMade) {
  record({{"/a", "std_msgs/msg/String", 100, 100}});
  const RunContents before = read_contents(recording_.path());
  record({{"/a", "std_msgs/msg/String", 150, 100}, {"/later", "std_msgs/msg/String", 10, 100}});
  EXPECT_EQ(reduced(recording_.path(), before, true).messages, 100U);
  record({{"/later", "std_msgs/msg/String", 10, 100}});
  EXPECT_EQ(reduced(recording_.path(), before, true).messages, 0U) << "another one by that name";
}

TEST_F(ReportTest, NotesThatItShowsNoArm) {
  record({{.name = "/joint_states", .type = "sensor_msgs/msg/JointState", .count = 10}});
  const WrittenReport written = write_report(
      {.recording = recording_.path(), .out = out_.path(), .page = page_.path(), .force = true});
  EXPECT_THAT(written.notes,
              testing::Contains(HasSubstr("has no /robot_description: the page shows no arm")));
}

TEST_F(ReportTest, SaysThatItsRecordingWasCutOff) {
  record({{"/a", "std_msgs/msg/String", 1000, 100}});
  std::string bytes = recording_.bytes();
  bytes.resize(bytes.size() - 40);
  recording_.replace(bytes);
  ASSERT_EQ(report(), kOk) << reason_;
  EXPECT_THAT(out_.bytes(), Not(HasSubstr("whole and unchanged")));
  EXPECT_EQ(counts().at("/a"), 1000);
}

}  // namespace
}  // namespace armature
