// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/chain_messages.hpp"

#include <gtest/gtest.h>

namespace armature {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d link(double x, double angle) {
  return Eigen::Translation3d{x, 2 * x, -x} *
         Eigen::AngleAxisd{angle, Vector3d{1, x, 2}.normalized()};
}

GuidedChain chain() {
  return {.base_T_tracker = link(1, 0.3),
          .flange_T_body = link(0.1, 2),
          .tip = {0.01, 0.02, 0.03},
          .flange_R_tool = Eigen::Quaterniond{link(0, 1).linear()},
          .tracker_T_patient = link(1.5, -1),
          .patient_T_image = link(0.03, 0.2)};
}

TEST(ChainMessages, AChainIsReadAsItWasWritten) {
  msg::TFMessage message;
  write_chain(chain(), Time{5}, message);
  EXPECT_EQ(message.transforms_().size(), 5u);
  const auto read = chain_of(message);
  ASSERT_TRUE(read) << read.error().text;
  const Isometry3d site = link(0.02, 0.7);
  EXPECT_LT((read->base_T_flange(site).matrix() - chain().base_T_flange(site).matrix()).norm(),
            1e-14);
  EXPECT_LT((read->base_T_site(site).matrix() - chain().base_T_site(site).matrix()).norm(), 1e-14);
  EXPECT_LT((read->tip - chain().tip).norm(), 1e-15);
  EXPECT_LT((read->base_T_tracker.matrix() - chain().base_T_tracker.matrix()).norm(), 1e-15);
}

TEST(ChainMessages, AMissingLinkIsNamed) {
  msg::TFMessage message;
  write_chain(chain(), Time{}, message);
  message.transforms_().erase(message.transforms_().begin() + 3);
  const auto read = chain_of(message);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().text, "no transform from 'tracker' to 'patient'");
}

TEST(ChainMessages, ALinkThatIsNoPoseIsNamed) {
  msg::TFMessage message;
  write_chain(chain(), Time{}, message);
  message.transforms_()[3].transform_().rotation_() = {};
  const auto read = chain_of(message);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().text,
            "the transform from 'tracker' to 'patient': its quaternion has length 0, not 1");
}

TEST(ChainMessages, NothingIsLeftOfTheChainBefore) {
  msg::TFMessage message;
  write_chain(chain(), Time{}, message);
  write_chain(GuidedChain{}, Time{}, message);
  EXPECT_EQ(message.transforms_().size(), 5u);
  EXPECT_EQ(chain_of(message)->tip, Vector3d::Zero());
}

}  // namespace
}  // namespace armature
