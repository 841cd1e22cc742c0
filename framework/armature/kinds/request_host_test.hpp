// SPDX-License-Identifier: Apache-2.0
// Hosts that answer requests, on a bench.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "armature/runtime/testing/component_harness.hpp"

namespace armature {

template <class Request, class Response>
class RequestHostTest : public ::testing::Test {
 protected:
  RequestHostTest(PluginRegistry& plugins, const ComponentHarness::Options& options)
      : host_{plugins, options} {}

  Response ask(const Request& request) {
    host_.send("request", request);
    host_.step(0.1);
    const auto answers = host_.template take<Response>("response");
    EXPECT_EQ(answers.size(), 1u);
    return answers.empty() ? Response{} : answers.front();
  }

  /// Every request is answered once, in order, under its header and id.
  std::vector<Response> expect_answered_in_order(const std::vector<Request>& requests) {
    for (const Request& request : requests) host_.send("request", request);
    EXPECT_TRUE(host_.triggered());
    host_.step(0.1);
    const auto answers = host_.template take<Response>("response");
    EXPECT_EQ(answers.size(), requests.size());
    for (std::size_t i = 0; i < answers.size() && i < requests.size(); ++i) {
      EXPECT_EQ(answers[i].request_id_(), requests[i].request_id_());
      EXPECT_EQ(answers[i].header_(), requests[i].header_());
    }
    host_.step(0.2);
    EXPECT_TRUE(host_.template take<Response>("response").empty());
    return answers;
  }
  /// The same of one that is refused between two that are not.
  void expect_bad_one_refused_between(const Request& first, const Request& bad,
                                      const Request& last) {
    const auto answers = expect_answered_in_order({first, bad, last});
    ASSERT_EQ(answers.size(), 3u);
    EXPECT_TRUE(answers[0].valid_());
    EXPECT_FALSE(answers[1].valid_());
    EXPECT_TRUE(answers[2].valid_());
  }

  /// Why `bad` is refused, with nothing but the reason, and `good` is answered after it.
  std::string refusal_of(const Request& bad, const Request& good) {
    const Response answer = ask(bad);
    Response nothing;
    nothing.header_(answer.header_());
    nothing.request_id_(bad.request_id_());
    nothing.reason_(answer.reason_());
    EXPECT_TRUE(answer == nothing);
    EXPECT_TRUE(ask(good).valid_());
    return answer.reason_();
  }
  /// What the plugin throws while `throws` is a reason, and the next request is answered.
  void expect_survives(bool& throws, const Request& request) {
    throws = true;
    const Response answer = ask(request);
    throws = false;
    EXPECT_FALSE(answer.valid_());
    EXPECT_EQ(answer.reason_(), "the plugin threw: the matrix is singular");
    EXPECT_TRUE(ask(request).valid_());
  }

  ComponentHarness host_;
};

}  // namespace armature
