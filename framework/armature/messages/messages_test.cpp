// SPDX-License-Identifier: Apache-2.0
// Rules proved here:
//  1. every type of idl/ is in the table, and every type of the table survives encode and decode
//  2. CDR is plain little endian behind its 4-byte header, as ROS 2 and other DDS programs read it
//  3. a layout hash belongs to one type
//  4. truncated or hostile CDR is refused with a reason; it never crashes or allocates at will
//  5. the generic reading by IDL agrees with the generated code
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/cdr_check.hpp"
#include "armature/messages/cdr_to_json.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/known_types.hpp"
#include "armature/messages/ros_definition.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/messages/stamp.hpp"
#include "armature/messages/test_messages.hpp"
#include "armature/messages/tf2_msgs.hpp"
#include "armature/messages/type_description.hpp"
#include "armature/messages/visualization_msgs.hpp"
#include "tests/text.hpp"

namespace armature {
namespace {

std::vector<std::byte> encoded(const MessageType& type, const void* message) {
  std::vector<std::byte> cdr;
  type.encode(message, cdr);
  return cdr;
}

template <class Message>
std::vector<std::byte> encoded(const Message& message) {
  return encoded(message_type<Message>(), &message);
}

msg::JointState joint_state() {
  msg::JointState js;
  set_stamp(js.header_().stamp_(), Time{12'345'678'901});
  js.header_().frame_id_("base");
  js.name_({"j1", "j2"});
  js.position_({0.5, -1.25});
  js.velocity_({1e-3, 2.0});
  return js;
}

/// Of idl/, read as a user would read it.
const TypeDescriptions& idl_types() {
  static const TypeDescriptions types = [] {
    TypeDescriptions read;
    for (const char* package :
         {"builtin_interfaces", "std_msgs", "geometry_msgs", "tf2_msgs", "sensor_msgs",
          "trajectory_msgs", "diagnostic_msgs", "rosgraph_msgs", "rcl_interfaces",
          "visualization_msgs", "armature_msgs"}) {
      const std::string file = std::string{ARMATURE_SOURCE_DIR "/idl/"} + package + ".idl";
      const auto added = read.add(test::text_of(file), file);
      EXPECT_TRUE(added) << added.error().text;
    }
    return read;
  }();
  return types;
}

TEST(Messages, EveryTypeOfTheIdlIsKnown) {
  std::set<std::string> described;
  for (const auto& type : idl_types().all()) described.insert(type->dds_name);
  std::set<std::string> known;
  for (const MessageType* type : known_message_types()) known.insert(std::string{type->dds_name});
  EXPECT_EQ(described, known);
}

TEST(Messages, AreFoundByRosNameAndByDdsName) {
  const MessageType& type = message_type<msg::JointState>();
  EXPECT_EQ(type.ros_name, "sensor_msgs/JointState");
  EXPECT_EQ(type.dds_name, "sensor_msgs::msg::dds_::JointState_");
  EXPECT_EQ(find_message_type("sensor_msgs/JointState"), &type);
  EXPECT_EQ(find_message_type("sensor_msgs::msg::dds_::JointState_"), &type);
  EXPECT_EQ(find_message_type("sensor_msgs/JointStates"), nullptr);
}

TEST(Messages, EveryTypeSurvivesDecodeAndEncode) {
  constexpr std::uint32_t kSeed = 20250;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  RandomCdr random{kSeed};
  for (const MessageType* type : known_message_types()) {
    SCOPED_TRACE(type->ros_name);
    AnyMessage any{*type};
    for (int round = 0; round < 50; ++round) {
      const auto cdr = random.of(*describe_type(type->dds_name));
      ASSERT_TRUE(type->decode(cdr, any.message));
      ASSERT_EQ(encoded(*type, any.message), cdr);
    }
  }
}

TEST(Messages, EncodeAppends) {
  const auto js = joint_state();
  std::vector<std::byte> cdr{std::byte{7}};
  message_type<msg::JointState>().encode(&js, cdr);
  const auto alone = encoded(js);
  ASSERT_EQ(cdr.size(), alone.size() + 1);
  EXPECT_TRUE(std::equal(alone.begin(), alone.end(), cdr.begin() + 1));
}

TEST(Messages, CdrIsLittleEndianBehindItsHeader) {
  msg::LightLevel level;
  level.header_().frame_id_("ab");
  level.header_().stamp_().sec_(1);
  level.level_(1.0);
  const std::vector<unsigned char> expected{0, 1, 0, 0,                     // encapsulation
                                            1, 0, 0, 0, 0,   0,   0,    0,  // stamp
                                            3, 0, 0, 0, 'a', 'b', 0,    0,  // frame, padding
                                            0, 0, 0, 0, 0,   0,   0xf0, 0x3f};
  std::vector<unsigned char> bytes;
  for (const std::byte b : encoded(level)) bytes.push_back(std::to_integer<unsigned char>(b));
  EXPECT_EQ(bytes, expected);
}

TEST(Messages, BigEndianIsReadToo) {
  const std::vector<std::byte> cdr{std::byte{0}, std::byte{0}, std::byte{0}, std::byte{0},
                                   std::byte{0}, std::byte{0}, std::byte{1}, std::byte{2},
                                   std::byte{0}, std::byte{0}, std::byte{0}, std::byte{9}};
  msg::Time time;
  ASSERT_TRUE(message_type<msg::Time>().decode(cdr, &time));
  EXPECT_EQ(time.sec_(), 258);
  EXPECT_EQ(time.nanosec_(), 9U);
  EXPECT_EQ((*cdr_to_json(*describe_type("builtin_interfaces/Time"), cdr))["sec"], 258);
}

TEST(Messages, StampIsThatOfTheHeader) {
  const auto js = joint_state();
  EXPECT_EQ(message_type<msg::JointState>().stamp(&js).ns, 12'345'678'901);
  EXPECT_EQ(message_type<msg::Point>().stamp, nullptr);
}

TEST(Messages, StampsBeforeTheEpochComeBack) {
  for (const std::int64_t ns : {0L, 1L, -1L, -1'000'000'000L, -1'000'000'001L, 999'999'999L}) {
    msg::Time stamp;
    set_stamp(stamp, Time{ns});
    EXPECT_LT(stamp.nanosec_(), 1'000'000'000U);
    EXPECT_EQ(stamp_of(stamp).ns, ns);
  }
}

TEST(Messages, PosesComeBackFromEigen) {
  const Eigen::Isometry3d a_T_b = Eigen::Translation3d{1, 2, 3} *
                                  Eigen::AngleAxisd{0.7, Eigen::Vector3d{1, 2, -1}.normalized()};
  msg::Pose pose;
  assign(pose, a_T_b);
  EXPECT_TRUE(to_eigen(pose).isApprox(a_T_b, 1e-15));
  msg::Transform transform;
  assign(transform, a_T_b);
  EXPECT_TRUE(to_eigen(transform).isApprox(a_T_b, 1e-15));
}

TEST(Messages, EveryLayoutHashIsDifferent) {
  std::set<std::uint64_t> hashes;
  for (const MessageType* type : known_message_types()) hashes.insert(type->layout);
  EXPECT_EQ(hashes.size(), known_message_types().size());
}

TEST(Messages, ChangingAnythingInALayoutChangesItsHash) {
  const auto hash = [](const std::string& members) {
    TypeDescriptions types;
    EXPECT_TRUE(types.add("@final struct X_ { " + members + " };", "x.idl"));
    return layout_hash(*types.find("X_"));
  };
  const std::set<std::uint64_t> hashes{hash("long a_;"),
                                       hash("unsigned long a_;"),
                                       hash("long b_;"),
                                       hash("long a_[2];"),
                                       hash("long a_[3];"),
                                       hash("sequence<long> a_;"),
                                       hash("sequence<long,2> a_;"),
                                       hash("long a_; long b_;"),
                                       hash("long b_; long a_;")};
  EXPECT_EQ(hashes.size(), 9U);
}

TEST(Cdr, TruncatedAtEveryLengthIsRefused) {
  RandomCdr random{7};
  for (const MessageType* type : known_message_types()) {
    SCOPED_TRACE(type->ros_name);
    AnyMessage any{*type};
    const TypeDescription& description = *describe_type(type->dds_name);
    const auto cdr = random.of(description);
    for (std::size_t length = 0; length < cdr.size(); ++length) {
      const std::span<const std::byte> part{cdr.data(), length};
      ASSERT_FALSE(type->decode(part, any.message)) << length;
      ASSERT_FALSE(cdr_to_json(description, part)) << length;
    }
  }
}

TEST(Cdr, RandomDamageNeverCrashes) {
  constexpr std::uint32_t kSeed = 99;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random{kSeed};
  RandomCdr contents{kSeed};
  for (const MessageType* type : known_message_types()) {
    AnyMessage any{*type};
    const TypeDescription& description = *describe_type(type->dds_name);
    for (int round = 0; round < 200; ++round) {
      auto cdr = contents.of(description);
      for (int hits = 0; hits < 3; ++hits) {
        cdr[4 + random() % (cdr.size() - 4)] = static_cast<std::byte>(random());
      }
      const bool decoded = type->decode(cdr, any.message);
      if (decoded) {
        EXPECT_TRUE(cdr_to_json(description, cdr)) << type->ros_name;
      }
    }
  }
}

TEST(Cdr, AnAnnouncedLengthBeyondTheBytesIsNamed) {
  auto cdr = encoded(joint_state());
  // header: 8 stamp, 4 + 5 frame, 3 padding; then the number of names
  const std::uint32_t hostile = 0x7fffffff;
  std::memcpy(cdr.data() + 4 + 20, &hostile, sizeof hostile);
  const auto checked = check_cdr(*describe_type("sensor_msgs/JointState"), cdr);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().text,
            "sensor_msgs/JointState.name: does not fit into the 96 bytes, from byte 28 on");
}

TEST(Cdr, BytesLeftOverAreRefused) {
  auto cdr = encoded(joint_state());
  cdr.resize(cdr.size() + 3);
  EXPECT_TRUE(check_cdr(*describe_type("sensor_msgs/JointState"), cdr));  // padding
  cdr.resize(cdr.size() + 1);
  EXPECT_FALSE(check_cdr(*describe_type("sensor_msgs/JointState"), cdr));
}

TEST(Cdr, OtherEncodingsAreRefused) {
  auto cdr = encoded(joint_state());
  cdr[1] = std::byte{3};  // parameter list
  const auto checked = check_cdr(*describe_type("sensor_msgs/JointState"), cdr);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().text,
            "sensor_msgs/JointState: 96 bytes that do not begin with a plain CDR header (00 00 or "
            "00 01)");
}

TEST(CdrToJson, ShowsTheFields) {
  const auto json = cdr_to_json(*describe_type("sensor_msgs/JointState"), encoded(joint_state()));
  ASSERT_TRUE(json);
  EXPECT_EQ(json->dump(),
            R"({"header":{"stamp":{"sec":12,"nanosec":345678901},"frame_id":"base"},)"
            R"("name":["j1","j2"],"position":[0.5,-1.25],"velocity":[0.001,2.0],"effort":[]})");
}

TEST(CdrToJson, ShortensImagesUnlessAskedNotTo) {
  msg::Image image;
  image.data_().assign(1000, 5);
  const TypeDescription& type = *describe_type("sensor_msgs/Image");
  const auto shortened = *cdr_to_json(type, encoded(image));
  EXPECT_EQ(shortened["data"]["octets"], 1000);
  EXPECT_EQ(shortened["data"]["first"].size(), 64U);
  EXPECT_EQ((*cdr_to_json(type, encoded(image), OctetArrays::whole))["data"].size(), 1000U);
}

TEST(CdrToJson, ReadsNestedSequencesAndArrays) {
  msg::CameraInfo info;
  info.d_({1, 2});
  info.p_()[3] = -60.5;
  info.roi_().do_rectify_(true);
  const auto json = *cdr_to_json(*describe_type("sensor_msgs/CameraInfo"), encoded(info));
  EXPECT_EQ(json["d"], nlohmann::ordered_json({1.0, 2.0}));
  EXPECT_EQ(json["p"][3], -60.5);
  EXPECT_EQ(json["roi"]["do_rectify"], true);

  msg::MarkerArray markers;
  markers.markers_().resize(2);
  markers.markers_()[1].text_("hello");
  markers.markers_()[1].points_().resize(3);
  const auto shown =
      *cdr_to_json(*describe_type("visualization_msgs/MarkerArray"), encoded(markers));
  EXPECT_EQ(shown["markers"][1]["text"], "hello");
  EXPECT_EQ(shown["markers"][1]["points"].size(), 3U);
}

TEST(Idl, MistakesAreToldWithTheirLine) {
  const auto reason = [](std::string_view idl) {
    TypeDescriptions types;
    const auto added = types.add(idl, "a.idl");
    return added ? std::string{} : added.error().text;
  };
  EXPECT_EQ(reason("module a {\n@final struct B_ {\n  lang x_;\n};\n};"),
            "a.idl:3: unknown type 'lang'");
  EXPECT_EQ(reason("@final struct B_ { long x_[0]; };"), "a.idl:1: '0' is not a length");
  EXPECT_EQ(reason("@final struct B_ { long x_ };"), "a.idl:1: expected ';' before '}'");
  EXPECT_EQ(reason("@final struct B_ { };"), "a.idl:1: struct B_ has no members");
  EXPECT_EQ(reason("@final struct B_ { long x_;"), "a.idl:1: unexpected end of the file");
}

TEST(Idl, UnknownTypesAreNotDescribed) { EXPECT_EQ(describe_type("a/B"), nullptr); }

TEST(Idl, RosMessageFilesSayTheSame) {
  int compared = 0;
  for (const auto& type : idl_types().all()) {
    if (!type->ros_name.starts_with("armature_msgs/")) continue;
    const std::string name = type->ros_name.substr(type->ros_name.find('/') + 1);
    std::ifstream file{ARMATURE_SOURCE_DIR "/idl/msg/" + name + ".msg"};
    std::vector<std::string> stated;
    for (std::string line; std::getline(file, line);) {
      line = line.substr(0, line.find('#'));
      while (line.ends_with(' ')) line.pop_back();
      if (!line.empty()) stated.push_back(line);
    }
    std::vector<std::string> expected;
    for (const FieldDescription& field : type->fields) {
      expected.push_back(ros_field(field, "armature_msgs"));
    }
    EXPECT_EQ(stated, expected) << name;
    ++compared;
  }
  EXPECT_EQ(compared, 59);
}

}  // namespace
}  // namespace armature
