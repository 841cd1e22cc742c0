// SPDX-License-Identifier: Apache-2.0
#include "png_encoder.hpp"

#include <zlib.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace armature::png {
namespace {

constexpr char kBitsOfASample = 8;
constexpr char kGrey = 0, kColour = 2;   // types of colour
constexpr char kLessThePixelBefore = 1;  // the row filter "Sub"
constexpr int kCompression = 4;          // of zlib, 1 is fast, 9 is small

void append_number(std::string& out, std::uint32_t number) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<char>((number >> shift) & 0xFF));
}

/// Length, type and data, and the checksum of the last two.
void append_chunk(std::string& out, std::string_view type, std::string_view data) {
  append_number(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t checked = out.size();
  out.append(type).append(data);
  const auto* bytes = reinterpret_cast<const Bytef*>(out.data() + checked);
  append_number(
      out, static_cast<std::uint32_t>(crc32(0, bytes, static_cast<uInt>(out.size() - checked))));
}

/// All rows, each with its filter first: of every byte what it is more than that of the pixel
/// before. Blue, green and red become red, green and blue.
std::string filtered(const Pixels& pixels) {
  const auto channels = static_cast<std::size_t>(pixels.channels);
  std::string rows;
  rows.reserve(static_cast<std::size_t>(pixels.height) *
               (1 + channels * static_cast<std::size_t>(pixels.width)));
  for (int v = 0; v < pixels.height; ++v) {
    const std::uint8_t* row = pixels.data + static_cast<std::size_t>(v) * pixels.stride;
    rows.push_back(kLessThePixelBefore);
    for (int u = 0; u < pixels.width; ++u, row += channels) {
      for (std::size_t c = channels; c-- > 0;) {
        const int before = u == 0 ? 0 : (row - channels)[c];
        rows.push_back(static_cast<char>(row[c] - before));
      }
    }
  }
  return rows;
}

std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                kCompression) != Z_OK) {
    throw std::runtime_error("zlib could not compress a picture");
  }
  out.resize(size);
  return out;
}

}  // namespace

std::string encoded(const Pixels& pixels) {
  const bool known = pixels.channels == 1 || pixels.channels == 3;
  if (pixels.width < 1 || pixels.height < 1 || !known) {
    throw std::invalid_argument("a PNG has pixels, of 1 or 3 channels");
  }
  std::string header;
  append_number(header, static_cast<std::uint32_t>(pixels.width));
  append_number(header, static_cast<std::uint32_t>(pixels.height));
  header.append({kBitsOfASample, pixels.channels == 1 ? kGrey : kColour, 0, 0, 0});
  std::string out{"\x89PNG\r\n\x1a\n"};
  append_chunk(out, "IHDR", header);
  append_chunk(out, "IDAT", compressed(filtered(pixels)));
  append_chunk(out, "IEND", {});
  return out;
}

}  // namespace armature::png
