// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <functional>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

// Small TensorFlow Lite networks for tests: FlatBuffers whose tables have the fields of
// TensorFlow's schema.fbs by number.
namespace armature::landmarks::face_mesh::tflite {

using Bytes = std::string;
/// Appends itself to a file and answers where it begins.
using Part = std::function<std::size_t(Bytes&)>;

template <class T>
void put(Bytes& file, std::size_t at, T value) {
  for (std::size_t i = 0; i < sizeof value; ++i) {
    file[at + i] = static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i));
  }
}

inline std::size_t append(Bytes& file, std::size_t size) {
  file.resize((file.size() + 3) / 4 * 4, '\0');
  const std::size_t at = file.size();
  file.resize(at + size, '\0');
  return at;
}

/// A field of a table: a number, or a part that the table points to.
struct Field {
  std::size_t number;
  std::int32_t value = 0;
  Part part = nullptr;
};

inline Part table(const std::vector<Field>& fields) {
  return [=](Bytes& file) {
    const std::size_t count = fields.empty() ? 0 : fields.back().number + 1;
    const std::size_t offsets = append(file, 4 + 2 * count);
    const std::size_t at = append(file, 4 + 4 * fields.size());
    put(file, offsets, static_cast<std::uint16_t>(4 + 2 * count));
    put(file, offsets + 2, static_cast<std::uint16_t>(4 + 4 * fields.size()));
    put(file, at, static_cast<std::int32_t>(at - offsets));
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const Field& field = fields[i];
      const std::size_t place = at + 4 + 4 * i;
      put(file, offsets + 4 + 2 * field.number, static_cast<std::uint16_t>(place - at));
      put(file, place,
          field.part ? static_cast<std::int32_t>(field.part(file) - place) : field.value);
    }
    return at;
  };
}

inline Part list(const std::vector<Part>& parts) {
  return [=](Bytes& file) {
    const std::size_t at = append(file, 4 + 4 * parts.size());
    put(file, at, static_cast<std::uint32_t>(parts.size()));
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::size_t place = at + 4 + 4 * i;
      put(file, place, static_cast<std::uint32_t>(parts[i](file) - place));
    }
    return at;
  };
}

template <class T>
Part values(const std::vector<T>& numbers) {
  return [=](Bytes& file) {
    const std::size_t at = append(file, 4 + sizeof(T) * numbers.size());
    put(file, at, static_cast<std::uint32_t>(numbers.size()));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if constexpr (std::is_same_v<T, float>) {
        put(file, at + 4 + 4 * i, std::bit_cast<std::uint32_t>(numbers[i]));
      } else {
        put(file, at + 4 + sizeof(T) * i, numbers[i]);
      }
    }
    return at;
  };
}

inline Part text(std::string_view words) {
  return values(std::vector<std::uint8_t>(words.begin(), words.end()));
}

using Shape = std::vector<std::int32_t>;

enum Code {
  add = 0,
  conv = 3,
  depthwise_conv = 4,
  dequantize = 6,
  max_pool = 17,
  pad = 34,
  prelu = 54
};
enum Padding { same = 0, valid = 1 };

/// One network. Tensors are known by their number.
class Network {
 public:
  int input(const Shape& shape) { return inputs_ = {tensor(shape, 0, {})}, inputs_.front(); }
  /// Weights that are stored as float16, and are float32 when they are used.
  int weights(const Shape& shape, const std::vector<float>& numbers) {
    std::vector<std::uint8_t> raw;
    for (const float number : numbers) {
      const auto bits = Eigen::numext::bit_cast<std::uint16_t>(Eigen::half{number});
      raw.insert(raw.end(),
                 {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8)});
    }
    return run(dequantize, {tensor(shape, 1, raw)}, shape, {});
  }
  int integers(const Shape& shape, const std::vector<std::int32_t>& numbers) {
    std::vector<std::uint8_t> raw;
    for (const std::int32_t number : numbers) {
      for (int i = 0; i < 4; ++i) raw.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
    }
    return tensor(shape, 2, raw);
  }
  /// The tensor that an operator computes from others; `options` are its fields by number.
  int run(int code, const std::vector<std::int32_t>& from, const Shape& shape,
          const std::vector<Field>& options) {
    const int to = tensor(shape, 0, {});
    operators_.push_back(table({{0, static_cast<std::int32_t>(codes_.size())},
                                {1, 0, values(from)},
                                {2, 0, values(std::vector<std::int32_t>{to})},
                                {3, 1},
                                {4, 0, table(options)}}));
    codes_.push_back(table({{0, code}}));
    return to;
  }
  /// The file whose outputs are these tensors.
  Bytes file(const std::vector<std::int32_t>& outputs) const {
    const Part graph = table({{0, 0, list(tensors_)},
                              {1, 0, values(inputs_)},
                              {2, 0, values(outputs)},
                              {3, 0, list(operators_)}});
    const Part model =
        table({{0, 3}, {1, 0, list(codes_)}, {2, 0, list({graph})}, {4, 0, list(buffers_)}});
    Bytes file(8, '\0');
    put(file, 0, static_cast<std::uint32_t>(model(file)));
    return file.replace(4, 4, "TFL3");
  }

 private:
  int tensor(const Shape& shape, int type, const std::vector<std::uint8_t>& raw) {
    const auto number = static_cast<std::int32_t>(tensors_.size());
    buffers_.push_back(raw.empty() ? table({}) : table({{0, 0, values(raw)}}));
    tensors_.push_back(table({{0, 0, values(shape)},
                              {1, type},
                              {2, number},
                              {3, 0, text("tensor" + std::to_string(number))}}));
    return number;
  }

  std::vector<std::int32_t> inputs_;
  std::vector<Part> tensors_, buffers_, operators_, codes_;
};

}  // namespace armature::landmarks::face_mesh::tflite
