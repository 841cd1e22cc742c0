// SPDX-License-Identifier: Apache-2.0
// Rules proved here, of everything.idl and of the library that armature_add_messages makes of it:
//  1. every construct becomes a member that reads, writes, compares and goes through CDR and back
//  2. the types of a library that is loaded are known like the framework's own
//  3. a length that does not fit is refused before anything is allocated
//  4. two definitions of one type are refused in the process, and by their symbols
//  5. what is not supported is refused by name, with file and line
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "armature/messages/cdr_to_json.hpp"
#include "armature/messages/generator/message_code.hpp"
#include "armature/messages/message_library.hpp"
#include "armature/messages/test_messages.hpp"
#include "armature/values/temporary_folder.hpp"
#include "everything_msgs/everything.hpp"
#include "tests/refusal.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using everything_msgs::msg::Everything;

std::vector<std::byte> encoded(const Everything& message) {
  std::vector<std::byte> cdr;
  message_type<Everything>().encode(&message, cdr);
  return cdr;
}

TEST(Generator, MembersStartEmptyAndAreSetByValueMoveAndReference) {
  Everything message;
  EXPECT_EQ(message, Everything{});
  EXPECT_EQ(message.j_(), 0U);
  EXPECT_FALSE(message.a_());
  EXPECT_EQ(message.lengths_(), (std::array<double, 3>{}));
  message.header_().frame_id_("base");
  message.d_(-5);
  message.d_() -= 1;
  const std::string name = "a name that does not fit into the object itself";
  message.default_().name_(name);
  std::string moved = name;
  const char* const memory = moved.data();
  message.m_(std::move(moved));
  EXPECT_EQ(message.m_().data(), memory);
  EXPECT_EQ(message.default_().name_(), name);
  EXPECT_EQ(message.d_(), -6);
  EXPECT_NE(message, Everything{});
  message.texts_({"a", "b"});
  EXPECT_EQ(message.texts_().size(), 2U);
}

TEST(Generator, CopyingASequenceReusesItsMemory) {
  Everything message;
  message.few_().reserve(10);
  const void* const memory = message.few_().data();
  const std::vector<std::int32_t> two{1, 2};
  message.few_(two);
  EXPECT_EQ(message.few_().data(), memory);
}

TEST(Generator, ConstantsStandBesideTheTypes) {
  EXPECT_EQ(everything_msgs::msg::SIDES, 3);
  EXPECT_EQ(everything_msgs::msg::FAR_AWAY, -5'000'000'000);
  EXPECT_EQ(everything_msgs::msg::HALF, 0.5);
  EXPECT_TRUE(everything_msgs::msg::SURE);
  EXPECT_EQ(everything_msgs::msg::GREETING, "hello; // you");
}

TEST(Generator, TypesOfALoadedLibraryAreKnown) {
  const MessageType& type = message_type<Everything>();
  EXPECT_EQ(type.ros_name, "everything_msgs/Everything");
  EXPECT_EQ(type.dds_name, "everything_msgs::msg::dds_::Everything_");
  EXPECT_EQ(find_message_type("everything_msgs/Everything"), &type);
  EXPECT_EQ(type.layout, layout_hash(*describe_type("everything_msgs/Everything")));
  EXPECT_NE(type.stamp, nullptr);
  EXPECT_EQ(find_message_type("everything_msgs/Part")->stamp, nullptr);
}

TEST(Generator, RandomMessagesSurviveDecodeAndEncode) {
  RandomCdr random{31};
  for (int round = 0; round < 200; ++round) {
    auto cdr = random.of(*describe_type("everything_msgs/Part"));
    everything_msgs::msg::Part part;
    ASSERT_TRUE(message_type<everything_msgs::msg::Part>().decode(cdr, &part));
    cdr.clear();
    message_type<everything_msgs::msg::Part>().encode(&part, cdr);
  }
  int decoded = 0;
  for (int round = 0; round < 200; ++round) {
    const auto cdr = random.of(*describe_type("everything_msgs/Everything"));
    Everything message;
    if (!message_type<Everything>().decode(cdr, &message)) continue;  // three of `few`
    ++decoded;
    ASSERT_EQ(encoded(message), cdr);
    CdrSize size;
    message.serialize(size);
    EXPECT_EQ(size.bytes() + 4, cdr.size());
  }
  EXPECT_GT(decoded, 100);
}

TEST(Generator, JsonShowsWhatTheMembersHold) {
  Everything message;
  message.d_(-7);
  message.smalls_({-1, 2});
  message.flags_({true, false});
  message.ends_()[1].name_("end");
  const auto json = *cdr_to_json(*describe_type("everything_msgs/Everything"), encoded(message));
  EXPECT_EQ(json["d"], -7);
  EXPECT_EQ(json["smalls"].dump(), "[-1,2]");
  EXPECT_EQ(json["flags"].dump(), "[true,false]");
  EXPECT_EQ(json["ends"][1]["name"], "end");
}

TEST(Generator, ASequenceBeyondItsBoundIsRefusedByTheReader) {
  Everything message, read;
  message.few_({1, 2});
  EXPECT_TRUE(message_type<Everything>().decode(encoded(message), &read));
  message.few_({1, 2, 3});
  EXPECT_FALSE(message_type<Everything>().decode(encoded(message), &read));
}

TEST(Generator, HostileLengthsAllocateNothing) {
  Everything message;
  const auto empty = encoded(message);
  for (std::size_t at = 4; at + 4 <= empty.size(); at += 4) {
    auto cdr = empty;
    const std::uint32_t hostile = 0xfffffff0;
    std::memcpy(cdr.data() + at, &hostile, sizeof hostile);
    Everything read;
    message_type<Everything>().decode(cdr, &read);
    EXPECT_EQ(read.smalls_().capacity() + read.parts_().capacity() + read.texts_().capacity(), 0U);
    EXPECT_LT(read.m_().capacity(), 100U);
  }
}

TEST(Generator, AnotherDefinitionOfATypeIsRefusedInTheProcess) {
  const MessageLibrary other{
      "module everything_msgs { module msg { module dds_ { @final struct Part_ { long x_; }; }; }; "
      "};"};
  EXPECT_FALSE(other.make_known({}));
  EXPECT_EQ(test::refusal_of([&] {
              other.define<everything_msgs::msg::Part>("everything_msgs::msg::dds_::Part_");
            }),
            "everything_msgs::msg::dds_::Part_ cannot be used: message library:1: "
            "everything_msgs/Part is known with other members");
}

TEST(Generator, TheSameDefinitionAgainIsTheSameType) {
  EXPECT_TRUE(
      add_descriptions("module everything_msgs { module msg { module dds_ { @final struct "
                       "Part_ { int8 small_; string name_; }; }; }; };",
                       "copy.so"));
}

class Files : public testing::Test {
 protected:
  Files() { fs::create_directories(folder_ / "other"); }

  void write(const std::string& file, const std::string& text) const {
    std::ofstream{folder_ / file} << text;
  }
  /// Why `text` is refused, with the file named a.idl.
  std::string reason(const std::string& text) const {
    write("a.idl", text);
    IdlFiles files{"mine", {{folder_ / "other", "others"}}};
    const auto read = files.read(folder_ / "a.idl");
    std::string why = read ? "" : read.error().text;
    for (std::size_t at; (at = why.find(folder_.path().string() + "/")) != std::string::npos;) {
      why.erase(at, folder_.path().string().size() + 1);
    }
    return why;
  }
  std::string reason_in_module(const std::string& text) const {
    return reason("module p { module msg { module dds_ {\n" + text + "\n}; }; };");
  }

  const TemporaryFolder folder_;
};

TEST_F(Files, IncludesAreReadFirstAndNamedByTheirHeaders) {
  write("other/deep.idl", "");
  write("other/base.idl",
        "#include \"deep.idl\"\n"
        "module o { module msg { module dds_ { @final struct X_ { long a_; }; }; }; };");
  write("near.idl",
        "#include \"base.idl\"\nmodule n { module msg { module dds_ { @final struct Y_ { "
        "o::msg::dds_::X_ x_; }; }; }; };");
  write("a.idl",
        "#include \"near.idl\"\n#include <base.idl>\nmodule p { module msg { module dds_ { "
        "@final struct Z_ { n::msg::dds_::Y_ y_; }; }; }; };");
  IdlFiles files{"mine", {{folder_ / "other", "others"}}};
  ASSERT_TRUE(files.read(folder_ / "a.idl"));
  ASSERT_EQ(files.all().size(), 4U);
  EXPECT_EQ(files.all()[0].header, "others/deep.hpp");
  EXPECT_EQ(files.all()[1].header, "others/base.hpp");
  EXPECT_EQ(files.all()[2].header, "mine/near.hpp");
  EXPECT_EQ(files.all()[3].includes,
            (std::vector<std::string>{"mine/near.hpp", "others/base.hpp"}));
  const std::string header = message_header(files.all()[3], "");
  EXPECT_NE(header.find("#include \"mine/near.hpp\""), std::string::npos) << header;
  EXPECT_NE(header.find("using Z = ::p::msg::dds_::Z_;"), std::string::npos) << header;
}

TEST_F(Files, WhatIsMissingIsNamedWithWhereItWasLookedFor) {
  EXPECT_EQ(reason("\n#include \"none.idl\"\n"),
            "a.idl:2: no 'none.idl' in " + folder_.path().string() + ", other");
}

TEST_F(Files, TypesOutsideTheModulesOfRosAreRefused) {
  EXPECT_EQ(reason("module p { @final struct X_ { long a_; }; };"),
            "a.idl: p::X_ must stand in 'module PACKAGE { module msg { module dds_ {', as messages "
            "of ROS 2 do on DDS");
}

TEST_F(Files, WhatIsNotSupportedIsNamedWithItsLine) {
  EXPECT_EQ(reason_in_module("\nenum Colour { RED };"), "a.idl:3: 'enum' is not supported");
  EXPECT_EQ(reason_in_module("union U switch(long) {};"), "a.idl:2: 'union' is not supported");
  EXPECT_EQ(reason_in_module("typedef long L;"), "a.idl:2: 'typedef' is not supported");
  EXPECT_EQ(reason_in_module("struct X_ { long a_; };"),
            "a.idl:2: a struct must be '@final struct'");
  EXPECT_EQ(reason_in_module("@mutable struct X_ { long a_; };"),
            "a.idl:2: '@mutable' is not supported");
  EXPECT_EQ(reason_in_module("@final struct X_ : Y_ { long a_; };"),
            "a.idl:2: X_ has a base, which is not supported");
  EXPECT_EQ(reason_in_module("@final struct X_ {\n @key long a_; };"),
            "a.idl:3: '@key' is not supported");
  EXPECT_EQ(reason_in_module("@final struct X_ {\n wstring a_; };"),
            "a.idl:3: 'wstring' is not supported");
  EXPECT_EQ(reason_in_module("@final struct X_ { long double a_; };"),
            "a.idl:2: 'long double' is not supported");
  EXPECT_EQ(reason_in_module("@final struct X_ { string<5> a_; };"),
            "a.idl:2: a string with a bound");
  EXPECT_EQ(reason_in_module("@final struct X_ { sequence<sequence<long>> a_; };"),
            "a.idl:2: a sequence of sequences");
  EXPECT_EQ(reason_in_module("@final struct X_ { long a_[2][2]; };"),
            "a.idl:2: an array of arrays");
  EXPECT_EQ(reason_in_module("@final struct X_ { double a_[4000000000]; };"),
            "a.idl:2: struct X_ is too large");
  EXPECT_EQ(reason_in_module("@final struct X_ {\n\n long a; };"),
            "a.idl:4: 'a' must end in '_', as names of ROS 2 do on DDS");
  EXPECT_EQ(reason_in_module("@final struct X_ { long a_; long a_; };"),
            "a.idl:2: a second member 'a_'");
  EXPECT_EQ(reason_in_module("const octet A = 256;"), "a.idl:2: '256' is not a value of its type");
  EXPECT_EQ(reason_in_module("const p::Q A = 256;"), "a.idl:2: a constant of type 'p'");
}

}  // namespace
}  // namespace armature
