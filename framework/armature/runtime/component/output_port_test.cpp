// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component/output_port.hpp"

#include <gtest/gtest.h>

#include "armature/runtime/component/ports.hpp"

namespace armature {
namespace {

struct AtOnce final : Delivery {
  void publish(Topic& topic, SampleRef sample) override { topic.send(std::move(sample), {}); }
};
struct Reader final : Subscriber {
  void deliver(const SampleRef&) override {}
};

TEST(OutputPort, IsWantedWhenSomebodyReadsOrItIsLatched) {
  MessageType type;
  type.create = [] { return static_cast<void*>(new int{}); };
  type.destroy = [](void* message) { delete static_cast<int*>(message); };
  Topic topic{{.name = "rt/n", .type = &type}, 1};
  AtOnce delivery;
  const Inbox inbox{[] {}};
  OutputPort state{{.name = "n", .qos = QosProfile::state}, topic, delivery, inbox};
  OutputPort latched{{.name = "n", .qos = QosProfile::latched}, topic, delivery, inbox};
  EXPECT_FALSE(Output<int>{state}.has_subscribers());
  EXPECT_TRUE(Output<int>{latched}.has_subscribers()) << "for those who come later";
  Reader reader;
  topic.connect(reader);
  EXPECT_TRUE(Output<int>{state}.has_subscribers());
}

}  // namespace
}  // namespace armature
