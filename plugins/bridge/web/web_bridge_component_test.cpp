// SPDX-License-Identifier: Apache-2.0
// What is judged where no run is; tests/end_to_end/web_bridge_test.cpp has the runs.
#include <gmock/gmock.h>

#include <fstream>

#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"
#include "armature/values/temporary_folder.hpp"
#include "armature/web/web_server.hpp"

namespace armature::bridge::web {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

ComponentHarness::Options bridge_with(const std::string& params) {
  return {.component = "{plugin: bridge/web, params: {" + params + "}}", .robot = {}};
}

std::string refusal_with(const std::string& params) {
  return refusal_of(built_plugins(), bridge_with(params));
}

/// A file with a token, gone with the test.
class TokenFile {
 public:
  explicit TokenFile(const std::string& text) { std::ofstream{path_} << text; }
  const std::string& path() const { return path_; }

 private:
  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "monitor.token";
};

TEST(WebBridgeParameters, LeavesThePortAloneWhereItIsNotRun) {
  const WebServer other{{.protocols = {"lamp.v1"}}, {}};
  const ComponentHarness bench{built_plugins(),
                               bridge_with("port: " + std::to_string(other.port()))};
  EXPECT_EQ(bench.status().state, StatusReporter::State::ok);
}

TEST(WebBridgeParameters, RefusesWhatIsNoAddress) {
  EXPECT_EQ(refusal_with("address: localhost"),
            "bench:1:47: 'localhost' is no IPv4 address; 127.0.0.1 is for programs of this "
            "machine, 0.0.0.0 for all others, too");
}

TEST(WebBridgeParameters, RefusesWhatIsNoOrigin) {
  for (const char* wrong : {"foo", "http://a/", "http://"}) {
    EXPECT_THAT(refusal_with("origins: ['" + std::string{wrong} + "']"),
                HasSubstr("'" + std::string{wrong} + "' is no origin"));
  }
  EXPECT_EQ(refusal_with("origins: ['http://localhost:8080']"), "");
}

TEST(WebBridgeParameters, RefusesAnAddressOfTheNetworkWithoutAToken) {
  EXPECT_EQ(refusal_with("address: 0.0.0.0"),
            "bench:1:47: '0.0.0.0' is reached by other machines, who must say a token: name a "
            "file that has one, token_file: monitor.token");
  const TokenFile file{"0123456789abcdef\n"};
  EXPECT_EQ(refusal_with("address: 0.0.0.0, token_file: " + file.path()), "");
}

TEST(WebBridgeParameters, RefusesATokenFileWithoutAToken) {
  EXPECT_THAT(refusal_with("token_file: /nowhere/monitor.token"),
              EndsWith("'/nowhere/monitor.token': No such file or directory"));
  EXPECT_THAT(refusal_with("token_file: " + TokenFile{"\nsecret\n"}.path()),
              EndsWith("is no token: it is empty, or has blanks"));
  EXPECT_THAT(refusal_with("token_file: " + TokenFile{std::string(1001, 'a')}.path()),
              EndsWith("has 1001 bytes; at most 1000 are taken"));
  EXPECT_THAT(refusal_with("token_file: " + TokenFile{"my secret\n"}.path()),
              EndsWith("is no token: it is empty, or has blanks"));
}

}  // namespace
}  // namespace armature::bridge::web
