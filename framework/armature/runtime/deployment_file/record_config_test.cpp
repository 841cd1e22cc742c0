// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/deployment_file/record_config.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "armature/config/document.hpp"

namespace armature {
namespace {

/// The zone of the machine, for a while.
class InTimeZone {
 public:
  explicit InTimeZone(const char* zone) {
    if (const char* before = std::getenv("TZ")) before_ = before;
    set(zone);
  }
  ~InTimeZone() { set(before_ ? before_->c_str() : nullptr); }
  InTimeZone(const InTimeZone&) = delete;
  InTimeZone& operator=(const InTimeZone&) = delete;

 private:
  static void set(const char* zone) {
    zone ? setenv("TZ", zone, 1) : unsetenv("TZ");
    tzset();
  }
  std::optional<std::string> before_;
};

TEST(RecordConfig, NamesNoTwoTimesOfTheNightWhenSummerTimeEndsTheSame) {
  const InTimeZone berlin{"CET-1CEST,M3.5.0,M10.5.0/3"};
  RecordConfig record;
  record.file = "fault-%Y%m%d-%H%M%S.mcap";
  const Time summer{1'792'888'200'000'000'000};  // Sunday 2026-10-25 00:30:00 UTC: 02:30 there
  const Time winter = summer + seconds(3600.0);  // 02:30 there, again
  EXPECT_EQ(record.file_of("main", summer), "fault-20261025-003000.mcap");
  EXPECT_EQ(record.file_of("main", winter), "fault-20261025-013000.mcap");
  EXPECT_EQ(record.file_of("vision", winter), "fault-20261025-013000.vision.mcap");
}

/// Reads `text` as the `record:` of a file `lamp.yaml` in `folder`.
RecordConfig record_of(const std::string& folder, const std::string& text) {
  config::Problems problems;
  RecordConfig record = read_record(config::parse_text(text, folder + "/lamp.yaml"), problems);
  problems.throw_if_any();
  return record;
}

TEST(RecordConfig, TakesPercentSignsOfItsFolderAsTheyAreAndThoseOfTheNameForTheTime) {
  const Time start{1'792'888'200'000'000'000};  // 2026-10-25 00:30:00 UTC
  const RecordConfig record = record_of("/tmp/100%done", "file: runs/100%%-%Y-%d.mcap");
  EXPECT_EQ(record.file_of("main", start), "/tmp/100%done/runs/100%-2026-25.mcap");
  EXPECT_EQ(record.file_of("vision", start), "/tmp/100%done/runs/100%-2026-25.vision.mcap");
  EXPECT_EQ(record_of("/tmp/100%done", "file: /var/lamp-%Y.mcap").file_of("main", start),
            "/var/lamp-2026.mcap");
}

}  // namespace
}  // namespace armature
