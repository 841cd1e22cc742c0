// SPDX-License-Identifier: Apache-2.0
// A camera that fails in all ways: 1. what is sound comes with its own time, in order, 2. what is
// not is named and counted, and the camera runs again as soon as it can, 3. no buffer is lost.
#include "camera_reader.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "fake_camera_test.hpp"

namespace armature::camera::v4l2 {
namespace {

using Event = FakeCamera::Event;

constexpr Duration kMonotonicNow = seconds(50);
constexpr Time kDeploymentNow = Time{} + seconds(1000);

Event grey(std::uint8_t value, double at_s = 49.9) {
  return {.bytes = std::vector<std::uint8_t>(8, value), .at = seconds(at_s)};
}

class CameraReaderTest : public testing::Test {
 protected:
  CameraReaderTest() { camera_->monotonic = kMonotonicNow; }

  /// Runs the reader until all events have happened, and gives a line of each report.
  std::vector<std::string> reports() {
    FakeCamera* camera = camera_.get();
    CameraReader reader{std::move(camera_), settings_, timing_};
    DriverQueue<Report>* self = nullptr;
    DriverQueue<Report> queue{100, [&] { reader.run(*self); }};
    self = &queue;
    const std::string name = "camera";
    queue.start(name,
                {.now = [camera] { return kDeploymentNow + (camera->monotonic - kMonotonicNow); },
                 .wake = [] {},
                 .fault = [](const auto&) {}});
    while (!camera->is_idle) std::this_thread::yield();
    queued_at_the_end_ = camera->queued();
    queue.request_stop();
    EXPECT_TRUE(queue.join_until(std::chrono::steady_clock::now() + std::chrono::seconds{10}));
    EXPECT_FALSE(camera->is_open);
    timeouts_ = camera->timeouts;
    std::vector<std::string> lines;
    while (const auto report = queue.take())
      lines.push_back(line_of(report->stamp, report->sample));
    return lines;
  }
  static std::string line_of(Time stamp, const Report& report) {
    if (report.has_started) return "started";
    std::string line = report.was_bad ? "bad: " : "";
    if (report.lost_before > 0) line += std::to_string(report.lost_before) + " lost, ";
    if (!report.trouble.empty()) return line + report.trouble;
    EXPECT_EQ(report.pixels.size(), 8U);
    return line + std::to_string(report.pixels.at(0)) + " " +
           std::to_string((stamp - kDeploymentNow).count() / 1'000'000) + " ms";
  }

  std::unique_ptr<FakeCamera> camera_ = std::make_unique<FakeCamera>();
  StreamSettings settings_{.device = "/dev/video7", .width = 4, .height = 2};
  CameraReader::Timing timing_{.try_again = seconds(0.001)};
  std::size_t queued_at_the_end_ = 0;
  std::vector<Duration> timeouts_;
};

using Lines = std::vector<std::string>;

TEST_F(CameraReaderTest, PicturesComeWithTheMiddleOfTheirExposureOnTheDeploymentsClock) {
  timing_.delay = seconds(0.004);
  for (int i = 0; i < 10; ++i)
    camera_->events.push_back(grey(static_cast<std::uint8_t>(i), 49.9 + 0.01 * i));
  const auto lines = reports();
  ASSERT_EQ(lines.size(), 11U);
  EXPECT_EQ(lines[0], "started");
  EXPECT_EQ(lines[1], "0 -104 ms");
  EXPECT_EQ(lines[10], "9 -14 ms");
  EXPECT_EQ(queued_at_the_end_, 4U) << "every buffer was given back";
}

TEST_F(CameraReaderTest, APictureWithoutATimeOrWithAnImpossibleOneHasTheTimeWhenItCame) {
  Event untold = grey(1);
  untold.flags = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
  camera_->events = {untold, grey(2, 60), grey(3, 20), grey(4)};
  EXPECT_EQ(reports(), (Lines{"started", "1 0 ms", "2 0 ms", "3 0 ms", "4 -100 ms"}));
}

TEST_F(CameraReaderTest, AThreadThatIsSuspendedBetweenTheTwoClocksAsksThemAgain) {
  camera_->suspensions = {seconds(0.02), seconds(0.02)};
  camera_->events = {grey(1)};
  EXPECT_EQ(reports(), (Lines{"started", "1 -100 ms"}));
}

TEST_F(CameraReaderTest, PicturesThatAreShortOrDamagedAreNamedAndTheNextOneIsTaken) {
  Event short_one = grey(1), damaged = grey(2);
  short_one.bytes.pop_back();
  damaged.flags |= V4L2_BUF_FLAG_ERROR;
  camera_->events = {short_one, grey(10), damaged, {}, grey(11)};
  EXPECT_EQ(
      reports(),
      (Lines{"started", "bad: /dev/video7: a picture has 7 bytes, 4 a row; 4 x 2 pixels need 8",
             "10 -100 ms", "bad: /dev/video7: a picture is damaged, as the camera's driver says",
             "bad: /dev/video7: a picture has 0 bytes, 4 a row; 4 x 2 pixels need 8",
             "11 -100 ms"}));
  EXPECT_EQ(queued_at_the_end_, 4U);
}

TEST_F(CameraReaderTest, AJpegThatIsDamagedIsNamedAndTheNextOneIsTaken) {
  camera_->formats = {V4L2_PIX_FMT_MJPEG};
  std::vector<std::uint8_t> sound;
  cv::imencode(".jpg", cv::Mat(2, 4, CV_8UC1, cv::Scalar{100}), sound);
  const std::vector<std::uint8_t> cut(sound.begin(), sound.end() - 30);
  camera_->events = {{.bytes = sound, .at = seconds(49.9)},
                     {.bytes = cut, .at = seconds(49.9)},
                     {.bytes = std::vector<std::uint8_t>(500, 7), .at = seconds(49.9)},
                     {.bytes = sound, .at = seconds(49.9)}};
  const auto lines = reports();
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_EQ(lines[1], "100 -100 ms");
  EXPECT_EQ(lines[2].find("bad: /dev/video7: a JPEG cannot be unpacked: "), 0U) << lines[2];
  EXPECT_EQ(lines[3].find("bad: /dev/video7: a JPEG cannot be unpacked: "), 0U) << lines[3];
  EXPECT_EQ(lines[4], "100 -100 ms");
}

TEST_F(CameraReaderTest, ACameraThatIsUnpluggedIsNamedUntilItIsBack) {
  camera_->open_errors = {0, ENOENT, ENOENT};
  camera_->events = {grey(1), {.error = ENODEV}, grey(2)};
  EXPECT_EQ(reports(),
            (Lines{"started", "1 -100 ms",
                   "/dev/video7 (Fake) gives no more pictures: No such device; is it plugged in?",
                   "cannot open /dev/video7: No such file or directory; is it plugged in?",
                   "cannot open /dev/video7: No such file or directory; is it plugged in?",
                   "started", "2 -100 ms"}));
}

TEST_F(CameraReaderTest, ACameraThatFailsOrFallsSilentIsStartedAgain) {
  camera_->events = {grey(1), {.error = EIO},    grey(2), {.silence = true},
                     grey(3), {.error = EAGAIN}, grey(4)};
  EXPECT_EQ(reports(),
            (Lines{"started", "1 -100 ms",
                   "/dev/video7 (Fake) gives no more pictures: Input/output error", "started",
                   "2 -100 ms", "/dev/video7: no picture for 1 s; the camera is started again",
                   "started", "3 -100 ms", "4 -100 ms"}));
}

TEST_F(CameraReaderTest, TheFirstPictureOfAStartMayTakeLongerThanTheOthers) {
  camera_->events = {{.silence = true}, grey(1), {.silence = true}, grey(2)};
  timing_.timeout = seconds(0.5);
  EXPECT_EQ(
      reports(),
      (Lines{"started", "/dev/video7: no picture for 5 s; the camera is started again", "started",
             "1 -100 ms", "/dev/video7: no picture for 0.5 s; the camera is started again",
             "started", "2 -100 ms"}));
  EXPECT_EQ(timeouts_,
            (std::vector{seconds(5), seconds(5), seconds(0.5), seconds(5), seconds(0.5)}));
}

TEST_F(CameraReaderTest, ADriverThatTellsOfPicturesAndGivesNoneIsStartedAgain) {
  for (int i = 0; i < 100; ++i) camera_->events.push_back({.error = EAGAIN});
  camera_->events.push_back(grey(1));
  EXPECT_EQ(
      reports(),
      (Lines{
          "started",
          "/dev/video7: its driver tells of pictures and gives none; the camera is started again",
          "started", "1 -100 ms"}));
}

TEST_F(CameraReaderTest, PicturesThatTheKernelHasDroppedAreCounted) {
  Event after_three = grey(2);
  after_three.skipped = 3;
  Event late_first = grey(3);
  late_first.skipped = 9;
  camera_->events = {grey(1), after_three, {.error = EIO}, late_first};
  const auto lines = reports();
  ASSERT_EQ(lines.size(), 6U);
  EXPECT_EQ(lines[2], "3 lost, 2 -100 ms");
  EXPECT_EQ(lines[5], "3 -100 ms") << "a new start counts from the beginning";
}

TEST_F(CameraReaderTest, ACameraThatHasNotWhatIsAskedForIsNamedUntilAnotherOneIsThere) {
  camera_->sizes = {{640, 480}};
  FakeCamera* camera = camera_.get();
  CameraReader reader{std::move(camera_), settings_, timing_};
  DriverQueue<Report>* self = nullptr;
  DriverQueue<Report> queue{100, [&] { reader.run(*self); }};
  self = &queue;
  const std::string name = "camera";
  queue.start(name,
              {.now = [] { return kDeploymentNow; }, .wake = [] {}, .fault = [](const auto&) {}});
  std::optional<DriverQueue<Report>::Stamped> told;
  while (!(told = queue.take())) std::this_thread::yield();
  EXPECT_EQ(told->sample.trouble,
            "/dev/video7 (Fake) gives 640 x 480 pixels of GREY instead of 4 x 2 of GREY; it offers "
            "640 x 480");
  queue.request_stop();
  EXPECT_TRUE(queue.join_until(std::chrono::steady_clock::now() + std::chrono::seconds{10}));
  EXPECT_EQ(camera->starts, 0);
}

}  // namespace
}  // namespace armature::camera::v4l2
