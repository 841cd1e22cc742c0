// SPDX-License-Identifier: Apache-2.0
#include "readable_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

TEST(ReadableJson, PutsWhatFitsIntoALineThere) {
  EXPECT_EQ(readable(Json::parse(R"({"stamp":{"sec":1,"nanosec":2},"on":true})")),
            R"({"stamp": {"sec": 1, "nanosec": 2}, "on": true})");
  EXPECT_EQ(readable(Json::array()), "[]");
  EXPECT_EQ(readable(Json::object()), "{}");
}

TEST(ReadableJson, ShowsBytesThatAreNoCharacterAsOneThatSaysSo) {
  EXPECT_EQ(readable(Json{{"data", "Eintritt \xFC"}}), "{\"data\": \"Eintritt \xEF\xBF\xBD\"}");
  EXPECT_EQ(readable(Json{{"\xFF", 1}}), "{\"\xEF\xBF\xBD\": 1}");
}

TEST(ReadableJson, KeepsALongListOfNumbersInOneLine) {
  Json image{{"encoding", "mono8"}, {"data", {{"octets", 921600}, {"first", Json::array()}}}};
  for (int i = 0; i < 64; ++i) image["data"]["first"].push_back(i);
  const std::string text = readable(image);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 6) << text;
  EXPECT_NE(text.find("\n  \"first\": [0, 1, 2, "), std::string::npos) << text;
}

TEST(ReadableJson, IndentsWhatIsLongAndReadsBackAsTheSame) {
  Json message{{"header", {{"frame_id", "base"}}}, {"points", Json::array()}};
  for (int i = 0; i < 5; ++i)
    message["points"].push_back({{"x", 1.0 / 3 + i}, {"y", 0.1}, {"z", 0.2}});
  const std::string text = readable(message);
  EXPECT_NE(text.find("\n  {\"x\": 0.3333333333333333, \"y\": 0.1, \"z\": 0.2},\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(Json::parse(text), message);
}

}  // namespace
}  // namespace armature
