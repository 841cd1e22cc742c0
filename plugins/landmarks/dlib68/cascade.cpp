// SPDX-License-Identifier: Apache-2.0
#include "cascade.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "numbers_file.hpp"

namespace armature::landmarks::dlib68 {
namespace {

[[noreturn]] void refuse_model(const std::string& why) { throw dlib::serialization_error{why}; }

std::size_t read_size(std::istream& in) {
  constexpr unsigned long kMost = 1'000'000;  // of levels, trees, nodes, pixels
  unsigned long size = 0;
  dlib::deserialize(size, in);
  if (size > kMost) refuse_model("a part of it has " + std::to_string(size) + " pieces");
  return size;
}

/// Appends a column of `size` numbers to `numbers`. A model has millions of them, for which dlib
/// asks the stream six times each.
void read_column(std::istream& in, std::size_t size, std::vector<float>& numbers) {
  long rows = 0, columns = 0;  // both negative: the form in which dlib writes them today
  dlib::deserialize(rows, in);
  dlib::deserialize(columns, in);
  if (std::abs(columns) != 1 || static_cast<std::size_t>(std::abs(rows)) != size) {
    refuse_model("a leaf is of another number of landmarks");
  }
  auto* file = dynamic_cast<NumbersFile*>(in.rdbuf());
  for (std::size_t i = 0; i < size; ++i) {
    float number = 0;
    if (!file || !file->take(number)) dlib::deserialize(number, in);
    numbers.push_back(number);
  }
}

}  // namespace

Cascade Cascade::read(std::istream& in) {
  int version = 0;
  dlib::deserialize(version, in);
  if (version != 1) refuse_model("version " + std::to_string(version) + ", and 1 is known");
  Cascade cascade;
  dlib::deserialize(cascade.initial_, in);
  const auto coordinates = static_cast<std::size_t>(cascade.initial_.size());
  cascade.landmarks_ = coordinates / 2;
  for (std::size_t left = read_size(in); left > 0; --left) {
    cascade.levels_.push_back(read_level(in, coordinates));
  }
  std::vector<std::vector<unsigned long>> anchors;
  std::vector<std::vector<dlib::vector<float, 2>>> deltas;
  dlib::deserialize(anchors, in);
  dlib::deserialize(deltas, in);
  if (anchors.size() != cascade.levels_.size() || deltas.size() != cascade.levels_.size()) {
    refuse_model("its trees and its pixels are of different cascades");
  }
  for (std::size_t i = 0; i < cascade.levels_.size(); ++i) {
    cascade.levels_[i].anchor = std::move(anchors[i]);
    cascade.levels_[i].delta = std::move(deltas[i]);
    cascade.check(cascade.levels_[i]);
  }
  return cascade;
}

Cascade::Level Cascade::read_level(std::istream& in, std::size_t leaf_size) {
  Level level;
  level.trees = read_size(in);
  for (std::size_t i = 0; i < level.trees; ++i) {
    std::vector<dlib::impl::split_feature> splits;
    dlib::deserialize(splits, in);
    const std::size_t leaves = read_size(in);
    if (i == 0) {
      level.splits_of_tree = splits.size();
      level.splits.reserve(level.trees * splits.size());
      level.leaves.reserve(level.trees * leaves * leaf_size);
    }
    if (splits.size() != level.splits_of_tree || leaves != splits.size() + 1 ||
        !std::has_single_bit(leaves)) {
      refuse_model("its trees are not of one depth");
    }
    for (const auto& split : splits) {
      level.splits.push_back({.one = static_cast<std::uint32_t>(split.idx1),
                              .other = static_cast<std::uint32_t>(split.idx2),
                              .threshold = split.thresh});
    }
    for (std::size_t leaf = 0; leaf < leaves; ++leaf) read_column(in, leaf_size, level.leaves);
  }
  return level;
}

/// So that nothing outside of the tables is read, whatever the file says.
void Cascade::check(const Level& level) const {
  const std::size_t pixels = level.anchor.size();
  const bool known =
      level.delta.size() == pixels &&
      std::ranges::all_of(level.anchor, [&](auto anchor) { return anchor < landmarks_; }) &&
      std::ranges::all_of(level.splits, [&](const Split& split) {
        return split.one < pixels && split.other < pixels;
      });
  if (!known) refuse_model("its trees look at pixels that it does not have");
}

void Cascade::add_answers(const Level& level, const std::vector<float>& pixels,
                          std::vector<const float*>& answers, Shape& shape) const {
  constexpr std::size_t kAhead = 12;      // leaves that are on their way
  constexpr std::size_t kCacheLine = 64;  // [bytes]
  const auto size = static_cast<std::size_t>(shape.size());
  answers.resize(level.trees);
  const Split* splits = level.splits.data();
  const float* leaves = level.leaves.data();
  for (const float*& answer : answers) {
    std::size_t node = 0;
    while (node < level.splits_of_tree) {
      const Split& split = splits[node];
      node = 2 * node + (pixels[split.one] - pixels[split.other] > split.threshold ? 1 : 2);
    }
    answer = leaves + (node - level.splits_of_tree) * size;
    splits += level.splits_of_tree;
    leaves += (level.splits_of_tree + 1) * size;
  }
  const auto ask_for = [&](std::size_t tree) {
    const auto* leaf = reinterpret_cast<const char*>(answers[tree]);
    for (std::size_t at = 0; at < size * sizeof(float); at += kCacheLine) {
      __builtin_prefetch(leaf + at);
    }
  };
  for (std::size_t i = 0; i < std::min(kAhead, answers.size()); ++i) ask_for(i);
  const auto length = static_cast<Eigen::Index>(size);
  Eigen::Map<Eigen::ArrayXf> sum{shape.begin(), length};
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (i + kAhead < answers.size()) ask_for(i + kAhead);
    sum += Eigen::Map<const Eigen::ArrayXf>{answers[i], length};
  }
}

std::vector<Eigen::Vector2d> Cascade::find(const dlib_chip::Image& image,
                                           const dlib::rectangle& box) const {
  Shape shape = initial_;
  std::vector<float> pixels;
  std::vector<const float*> answers;
  for (const Level& level : levels_) {
    dlib::impl::extract_feature_pixel_values(image, box, shape, initial_, level.anchor, level.delta,
                                             pixels);
    add_answers(level, pixels, answers, shape);
  }
  const dlib::point_transform_affine image_T_box = dlib::impl::unnormalizing_tform(box);
  std::vector<Eigen::Vector2d> found;
  for (unsigned long i = 0; i < landmarks_; ++i) {
    const dlib::dpoint at = image_T_box(dlib::impl::location(shape, i));
    found.emplace_back(at.x(), at.y());
  }
  return found;
}

}  // namespace armature::landmarks::dlib68
