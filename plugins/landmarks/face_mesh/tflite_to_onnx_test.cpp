// SPDX-License-Identifier: Apache-2.0
// The converter of TensorFlow Lite to ONNX: 1. every operator computes with OpenCV what it is
// defined to compute, 2. what it does not know is refused, 3. so is what is no such file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/dnn.hpp>
#include <random>
#include <vector>

#include "conversion_test.hpp"
#include "tflite_writer_test.hpp"

namespace armature::landmarks::face_mesh {
namespace {

using testing::HasSubstr;

/// Rows, columns and channels of numbers.
struct Grid {
  int rows, columns, channels;
  std::vector<float> values =
      std::vector<float>(static_cast<std::size_t>(rows * columns * channels));

  float& at(int row, int column, int channel) {
    return values[static_cast<std::size_t>((row * columns + column) * channels + channel)];
  }
  float or_zero(int row, int column, int channel) {
    const bool is_inside = row >= 0 && row < rows && column >= 0 && column < columns;
    return is_inside ? at(row, column, channel) : 0;
  }
};

/// Numbers that float16 holds exactly.
std::vector<float> drawn(std::size_t count, std::mt19937& random) {
  std::vector<float> numbers(count);
  for (float& number : numbers)
    number = static_cast<float>(static_cast<int>(random() % 65) - 32) / 32;
  return numbers;
}

/// A convolution with 3 x 3 or 1 x 1 weights, of every channel alone where `depthwise`. The first
/// weight looks `before` rows and columns before the place that it is for.
Grid convolved(Grid from, int size, int stride, int before, int channels, bool depthwise,
               const std::vector<float>& weights, const std::vector<float>& offsets) {
  const int depth = depthwise ? 1 : from.channels;
  Grid to{(from.rows + stride - 1) / stride, (from.columns + stride - 1) / stride, channels};
  for (int row = 0; row < to.rows; ++row) {
    for (int column = 0; column < to.columns; ++column) {
      for (int out = 0; out < channels; ++out) {
        float sum = offsets[static_cast<std::size_t>(out)];
        for (int i = 0; i < size * size * depth; ++i) {
          const int in = depthwise ? out : i % depth, k = i / depth;
          const int weight = depthwise ? k * channels + out : out * size * size * depth + i;
          sum += weights[static_cast<std::size_t>(weight)] *
                 from.or_zero(row * stride - before + k / size, column * stride - before + k % size,
                              in);
        }
        to.at(row, column, out) = sum;
      }
    }
  }
  return to;
}

/// What OpenCV computes from `from` with the network of a file.
std::vector<float> computed(const std::string& file, Grid from) {
  cv::Mat input;
  input.create({1, from.channels, from.rows, from.columns}, CV_32F);
  auto* values = input.ptr<float>();
  for (int channel = 0; channel < from.channels; ++channel) {
    for (int row = 0; row < from.rows; ++row) {
      for (int column = 0; column < from.columns; ++column)
        *values++ = from.at(row, column, channel);
    }
  }
  cv::dnn::Net net = cv::dnn::readNetFromONNX(file);
  net.setInput(input);
  const cv::Mat answer = net.forward();
  return {answer.ptr<float>(), answer.ptr<float>() + answer.total()};
}

void expect_equal(const std::vector<float>& found, Grid expected) {
  ASSERT_EQ(found.size(), expected.values.size());
  auto value = found.begin();
  for (int channel = 0; channel < expected.channels; ++channel) {
    for (int row = 0; row < expected.rows; ++row) {
      for (int column = 0; column < expected.columns; ++column) {
        // Sums of some fifty products of numbers up to 10, in float32.
        EXPECT_NEAR(*value++, expected.at(row, column, channel), 1e-4)
            << "row " << row << ", column " << column << ", channel " << channel;
      }
    }
  }
}

const std::vector<tflite::Field> kConvValid{{0, tflite::valid}, {1, 1}, {2, 1}};

TEST(TfliteToOnnx, ConvertsEveryOperatorOfTheFaceMesh) {
  constexpr unsigned kSeed = 7;
  std::mt19937 random{kSeed};
  const auto k1 = drawn(4 * 9 * 3, random), o1 = drawn(4, random), slopes = drawn(4, random),
             k2 = drawn(9 * 4, random), o2 = drawn(4, random), k3 = drawn(6 * 4, random),
             o3 = drawn(6, random);
  Grid picture{8, 8, 3};
  picture.values = drawn(picture.values.size(), random);

  // Half of the resolution, twice, beside a pooled copy that gets two channels more.
  tflite::Network n;
  const int in = n.input({1, 8, 8, 3});
  const int a = n.run(tflite::conv, {in, n.weights({4, 3, 3, 3}, k1), n.weights({4}, o1)},
                      {1, 4, 4, 4}, {{0, tflite::same}, {1, 2}, {2, 2}});
  const int b = n.run(tflite::prelu, {a, n.weights({1, 1, 4}, slopes)}, {1, 4, 4, 4}, {});
  const int c = n.run(tflite::depthwise_conv, {b, n.weights({1, 3, 3, 4}, k2), n.weights({4}, o2)},
                      {1, 2, 2, 4}, {{0, tflite::same}, {1, 2}, {2, 2}, {3, 1}});
  const int d = n.run(tflite::conv, {c, n.weights({6, 1, 1, 4}, k3), n.weights({6}, o3)},
                      {1, 2, 2, 6}, kConvValid);
  const int e = n.run(tflite::max_pool, {b}, {1, 2, 2, 4},
                      {{0, tflite::valid}, {1, 2}, {2, 2}, {3, 2}, {4, 2}});
  const int f =
      n.run(tflite::pad, {e, n.integers({4, 2}, {0, 0, 0, 0, 0, 0, 0, 2})}, {1, 2, 2, 6}, {});
  const int g = n.run(tflite::add, {f, d}, {1, 2, 2, 6}, {});
  const std::string onnx = temporary("tiny.onnx");
  const Told told = converted(n.file({g}), onnx);
  ASSERT_TRUE(told.succeeded) << told.text;

  Grid straight = convolved(picture, 3, 2, 0, 4, false, k1, o1);
  for (std::size_t i = 0; i < straight.values.size(); ++i) {
    if (straight.values[i] < 0) straight.values[i] *= slopes[i % 4];
  }
  Grid expected =
      convolved(convolved(straight, 3, 2, 0, 4, true, k2, o2), 1, 1, 0, 6, false, k3, o3);
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      for (int channel = 0; channel < 4; ++channel) {
        expected.at(row, column, channel) +=
            std::max({straight.at(2 * row, 2 * column, channel),
                      straight.at(2 * row, 2 * column + 1, channel),
                      straight.at(2 * row + 1, 2 * column, channel),
                      straight.at(2 * row + 1, 2 * column + 1, channel)});
      }
    }
  }
  expect_equal(computed(onnx, picture), expected);
  std::filesystem::remove(onnx);
}

TEST(TfliteToOnnx, PadsOnBothSidesWhereTheStrideIsOne) {
  constexpr unsigned kSeed = 8;
  std::mt19937 random{kSeed};
  const auto weights = drawn(2 * 9 * 3, random), offsets = drawn(2, random);
  Grid picture{5, 4, 3};
  picture.values = drawn(picture.values.size(), random);
  tflite::Network n;
  const int in = n.input({1, 5, 4, 3});
  const int out =
      n.run(tflite::conv, {in, n.weights({2, 3, 3, 3}, weights), n.weights({2}, offsets)},
            {1, 5, 4, 2}, {{0, tflite::same}, {1, 1}, {2, 1}});
  const std::string onnx = temporary("padded.onnx");
  const Told told = converted(n.file({out}), onnx);
  ASSERT_TRUE(told.succeeded) << told.text;
  expect_equal(computed(onnx, picture), convolved(picture, 3, 1, 1, 2, false, weights, offsets));
  std::filesystem::remove(onnx);
}

TEST(TfliteToOnnx, PadsRowsColumnsAndChannels) {
  tflite::Network n;
  const int in = n.input({1, 1, 1, 1});
  const int sizes = n.integers({4, 2}, {0, 0, 1, 0, 0, 2, 0, 1});
  const std::string onnx = temporary("pad.onnx");
  const Told told = converted(n.file({n.run(tflite::pad, {in, sizes}, {1, 2, 3, 2}, {})}), onnx);
  ASSERT_TRUE(told.succeeded) << told.text;
  Grid expected{2, 3, 2};
  expected.at(1, 0, 0) = 5;
  expect_equal(computed(onnx, {1, 1, 1, {5}}), expected);
  std::filesystem::remove(onnx);
}

/// What the converter says of a network of one operator.
std::string refusal(int code, const std::vector<tflite::Field>& options) {
  tflite::Network n;
  const int in = n.input({1, 5, 5, 1});
  const int out =
      n.run(code, {in, n.weights({1, 3, 3, 1}, std::vector<float>(9)), n.weights({1}, {0})},
            {1, 3, 3, 1}, options);
  const Told told = converted(n.file({out}), temporary("refused.onnx"));
  EXPECT_FALSE(told.succeeded);
  return told.text;
}

TEST(TfliteToOnnx, RefusesWhatItDoesNotKnow) {
  constexpr int kTanh = 28;
  EXPECT_THAT(refusal(kTanh, {}), HasSubstr("the operator with number 28 is not known"));
  EXPECT_THAT(refusal(tflite::conv, {{0, tflite::valid}, {1, 1}, {2, 1}, {3, 1}}),
              HasSubstr("an activation inside of another operator is not known"));
  EXPECT_THAT(refusal(tflite::conv, {{0, tflite::valid}, {1, 1}, {2, 1}, {4, 2}}),
              HasSubstr("a dilated convolution is not known"));
  EXPECT_THAT(refusal(tflite::max_pool, {{0, tflite::same}, {1, 2}, {2, 2}, {3, 2}, {4, 2}}),
              HasSubstr("a MAX_POOL_2D whose input has to be padded is not known"));
}

TEST(TfliteToOnnx, RefusesBytesThatAreNoNetwork) {
  const auto says = [](const std::string& bytes) {
    const Told told = converted(bytes, temporary("refused.onnx"));
    EXPECT_FALSE(told.succeeded);
    EXPECT_THAT(told.text, testing::Not(HasSubstr("Traceback")));
    return told.text;
  };
  EXPECT_THAT(says("no network at all"), HasSubstr("it does not begin with TFL3"));
  EXPECT_THAT(says(""), HasSubstr("it does not begin with TFL3"));
  tflite::Network n;
  const std::string whole = n.file({n.run(tflite::add, {n.input({1, 2, 2, 1})}, {1, 2, 2, 1}, {})});
  for (const std::size_t size : {std::size_t{10}, whole.size() / 2, whole.size() - 3}) {
    EXPECT_THAT(says(whole.substr(0, size)), HasSubstr("the TensorFlow Lite model is damaged"))
        << size << " of " << whole.size() << " bytes";
  }
}

}  // namespace
}  // namespace armature::landmarks::face_mesh
