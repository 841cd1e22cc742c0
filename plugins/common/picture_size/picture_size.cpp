// SPDX-License-Identifier: Apache-2.0
#include "picture_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

namespace armature::pictures {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::int64_t kMaxSide = 16384, kMaxPixels = 100'000'000;

bool begins_with(Bytes bytes, std::string_view text) {
  return bytes.size() >= text.size() &&
         std::ranges::equal(bytes.first(text.size()), text, {}, {},
                            [](char c) { return static_cast<std::uint8_t>(c); });
}

/// A whole number of `count` bytes; nothing behind the end.
std::optional<std::int64_t> number_at(Bytes bytes, std::size_t at, std::size_t count,
                                      bool big_endian) {
  if (at > bytes.size() || bytes.size() - at < count) return std::nullopt;
  std::int64_t number = 0;
  for (std::size_t i = 0; i < count; ++i) {
    number = number << 8 | bytes[at + (big_endian ? i : count - 1 - i)];
  }
  return number;
}

using Told = std::optional<PictureSize>;

Told told(std::optional<std::int64_t> width, std::optional<std::int64_t> height) {
  return width && height ? Told{{*width, *height}} : std::nullopt;
}

Told told_by_png(Bytes bytes) {
  return told(number_at(bytes, 16, 4, true), number_at(bytes, 20, 4, true));
}

/// The height is negative where rows go downwards.
Told told_by_bmp(Bytes bytes) {
  constexpr std::int64_t kOldHeader = 12;
  const auto header = number_at(bytes, 14, 4, false);
  if (header == kOldHeader) {
    return told(number_at(bytes, 18, 2, false), number_at(bytes, 20, 2, false));
  }
  auto size = told(number_at(bytes, 18, 4, false), number_at(bytes, 22, 4, false));
  if (!size) return std::nullopt;
  for (std::int64_t* side : {&size->width, &size->height}) {
    *side = std::abs(std::int64_t{static_cast<std::int32_t>(*side)});
  }
  return size;
}

/// The entries of the first directory; the picture may be cut into tiles or strips of any size.
Told told_by_tiff(Bytes bytes) {
  constexpr std::int64_t kWidth = 256, kHeight = 257, kShort = 3, kLong = 4;
  constexpr std::size_t kEntry = 12;
  const bool big_endian = bytes[0] == 'M';
  const auto directory = number_at(bytes, 4, 4, big_endian);
  if (!directory) return std::nullopt;
  const auto begin = static_cast<std::size_t>(*directory);
  const auto count = number_at(bytes, begin, 2, big_endian);
  if (!count) return std::nullopt;
  std::optional<std::int64_t> width, height;
  for (std::size_t i = 0; i < static_cast<std::size_t>(*count); ++i) {
    const std::size_t at = begin + 2 + i * kEntry;
    const auto tag = number_at(bytes, at, 2, big_endian);
    const auto type = number_at(bytes, at + 2, 2, big_endian);
    if (!tag || !type) return std::nullopt;
    if (*tag != kWidth && *tag != kHeight) continue;
    if (*type != kShort && *type != kLong) return std::nullopt;
    const auto value = number_at(bytes, at + 8, *type == kShort ? 2 : 4, big_endian);
    if (!value) return std::nullopt;
    auto& side = *tag == kWidth ? width : height;
    side = std::max(side.value_or(0), *value);
  }
  return told(width, height);
}

/// "P5 # a comment\n640 480 255": two numbers behind the letters.
Told told_by_pnm(Bytes bytes) {
  std::size_t at = 2;
  const auto number = [&]() -> std::optional<std::int64_t> {
    while (at < bytes.size() && (std::isspace(bytes[at]) != 0 || bytes[at] == '#')) {
      if (bytes[at] == '#') {
        while (at < bytes.size() && bytes[at] != '\n' && bytes[at] != '\r') ++at;
      } else {
        ++at;
      }
    }
    constexpr std::int64_t kBeyond = 1'000'000'000;
    std::optional<std::int64_t> value;
    for (; at < bytes.size() && std::isdigit(bytes[at]) != 0; ++at) {
      value = std::min(10 * value.value_or(0) + bytes[at] - '0', kBeyond);
    }
    return value;
  };
  const auto width = number();
  return told(width, number());
}

bool is_pnm(Bytes bytes) {
  return bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6' &&
         std::isspace(bytes[2]) != 0;
}

}  // namespace

Expected<PictureSize> told_size(Bytes bytes) {
  using namespace std::string_view_literals;
  Told size;
  if (begins_with(bytes, "\x89PNG\r\n\x1a\n"sv)) {
    size = told_by_png(bytes);
  } else if (begins_with(bytes, "BM"sv)) {
    size = told_by_bmp(bytes);
  } else if (begins_with(bytes, "II*\0"sv) || begins_with(bytes, "MM\0*"sv)) {
    size = told_by_tiff(bytes);
  } else if (is_pnm(bytes)) {
    size = told_by_pnm(bytes);
  } else {
    return refuse("it is none of PNG, JPEG, PGM, PPM, BMP and TIFF");
  }
  if (!size) return refuse("its beginning does not say how many pixels it has");
  return *size;
}

Expected<void> check_size(const PictureSize& size) {
  if (std::max(size.width, size.height) > kMaxSide) {
    return refuse(fmt::format("it has {} x {} pixels; a side may have {}", size.width, size.height,
                              kMaxSide));
  }
  if (size.width * size.height > kMaxPixels) {
    return refuse(fmt::format("it has {} x {} pixels; a picture may have {} million", size.width,
                              size.height, kMaxPixels / 1'000'000));
  }
  return {};
}

}  // namespace armature::pictures
