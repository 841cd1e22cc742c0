// SPDX-License-Identifier: Apache-2.0
// The cascade against dlib's own evaluation of the same model: 1. the same landmarks, 2. models
// that would be read beyond their tables are refused.
#include "cascade.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>

#include "armature/kinds/drawn_face.hpp"
#include "tests/refusal.hpp"

namespace armature::landmarks::dlib68 {
namespace {

constexpr const char* kModel = "/usr/share/dlib/shape_predictor_68_face_landmarks.dat";

TEST(Cascade, FindsWhatDlibFindsWithTheSameModel) {
  std::ifstream file{kModel, std::ios::binary};
  const Cascade cascade = Cascade::read(file);
  dlib::shape_predictor dlibs;
  dlib::deserialize(kModel) >> dlibs;
  ASSERT_EQ(cascade.landmarks(), dlibs.num_parts());

  const DrawnPortrait portrait;
  const dlib_chip::Image image = dlib_chip::copied(portrait.picture.view());
  constexpr int kSeed = 2014;
  std::mt19937 random{kSeed};
  std::uniform_int_distribution<long> aside{-60, 60};
  for (int round = 0; round < 20; ++round) {
    const dlib::rectangle box{640 + aside(random), 190 + aside(random), 860 + aside(random),
                              410 + aside(random)};
    const dlib::full_object_detection expected = dlibs(image, box);
    const std::vector<Eigen::Vector2d> found = cascade.find(image, box);
    ASSERT_EQ(found.size(), expected.num_parts());
    for (unsigned long i = 0; i < expected.num_parts(); ++i) {
      const dlib::point rounded{dlib::dpoint{found[i].x(), found[i].y()}};
      EXPECT_EQ(rounded, expected.part(i)) << "seed " << kSeed << ", box " << round << ", " << i;
    }
  }
}

/// Two landmarks, two pixels and one tree for each given number of leaves, which looks at `pixel`.
std::string small_model(const std::vector<std::size_t>& leaves_of_trees, unsigned long pixel) {
  dlib::matrix<float, 0, 1> shape(4), leaf(4);
  shape = 0.25f, 0.5f, 0.75f, 0.5f;
  leaf = 0;
  std::vector<dlib::impl::regression_tree> forest;
  for (const std::size_t leaves : leaves_of_trees) {
    dlib::impl::regression_tree tree;
    tree.splits.assign(leaves - 1, {.idx1 = 0, .idx2 = pixel, .thresh = 0});
    tree.leaf_values.assign(leaves, leaf);
    forest.push_back(tree);
  }
  std::ostringstream file;
  serialize(dlib::shape_predictor{shape, {forest}, {{{0.2f, 0.2f}, {0.8f, 0.8f}}}}, file);
  return file.str();
}

std::string refusal(const std::string& model) {
  std::istringstream file{model};
  return test::refusal_of([&] { static_cast<void>(Cascade::read(file)); });
}

TEST(Cascade, RefusesModelsThatWouldBeReadBeyondTheirTables) {
  EXPECT_EQ(refusal(small_model({4, 4}, 1)), "");
  EXPECT_EQ(refusal(small_model({4, 4}, 2)), "its trees look at pixels that it does not have");
  EXPECT_EQ(refusal(small_model({4, 8}, 1)), "its trees are not of one depth");
  EXPECT_EQ(refusal(small_model({3}, 1)), "its trees are not of one depth");
  EXPECT_THAT(refusal(small_model({4, 4}, 1).substr(0, 100)), testing::HasSubstr("deserializ"));
}

}  // namespace
}  // namespace armature::landmarks::dlib68
