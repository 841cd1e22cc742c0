// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "armature/config/document.hpp"

namespace armature::config {
namespace {

TEST(Parsing, KeepsThePlaceOfEveryKeyAndValue) {
  const Node root = parse_text("a: 1\nb:\n  c: [x, y]\n", "f.yaml");
  EXPECT_EQ(root.entries()[1].key_origin.text(), "f.yaml:2:1");
  EXPECT_EQ(root.find("b")->find("c")->items()[1].origin().text(), "f.yaml:3:10");
}

}  // namespace
}  // namespace armature::config
