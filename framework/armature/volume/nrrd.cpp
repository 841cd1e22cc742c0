// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/nrrd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "armature/values/regular_file.hpp"
#include "armature/values/utf8.hpp"
#include "armature/volume/gzip_reader.hpp"
#include "armature/volume/nrrd_header.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

/// The `at`-th number of `bytes`.
template <class Number>
double number_at(std::string_view bytes, std::size_t at, bool big_endian) {
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), bytes.data() + at * sizeof(Number), sizeof(Number));
  if (big_endian) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<Number>(raw));
}

using Read = double (*)(std::string_view, std::size_t, bool);

struct NumberType {
  std::string_view name;
  std::size_t bytes;
  Read read;
};

constexpr NumberType kTypes[] = {{"signed char", 1, number_at<std::int8_t>},
                                 {"int8", 1, number_at<std::int8_t>},
                                 {"int8_t", 1, number_at<std::int8_t>},
                                 {"uchar", 1, number_at<std::uint8_t>},
                                 {"unsigned char", 1, number_at<std::uint8_t>},
                                 {"uint8", 1, number_at<std::uint8_t>},
                                 {"uint8_t", 1, number_at<std::uint8_t>},
                                 {"short", 2, number_at<std::int16_t>},
                                 {"short int", 2, number_at<std::int16_t>},
                                 {"signed short", 2, number_at<std::int16_t>},
                                 {"int16", 2, number_at<std::int16_t>},
                                 {"int16_t", 2, number_at<std::int16_t>},
                                 {"ushort", 2, number_at<std::uint16_t>},
                                 {"unsigned short", 2, number_at<std::uint16_t>},
                                 {"uint16", 2, number_at<std::uint16_t>},
                                 {"uint16_t", 2, number_at<std::uint16_t>},
                                 {"int", 4, number_at<std::int32_t>},
                                 {"int32", 4, number_at<std::int32_t>},
                                 {"int32_t", 4, number_at<std::int32_t>},
                                 {"float", 4, number_at<float>},
                                 {"double", 8, number_at<double>}};

const NumberType* type_named(std::string_view name) {
  const auto found = std::ranges::find(kTypes, name, &NumberType::name);
  return found == std::end(kTypes) ? nullptr : found;
}

/// Fills a piece with the bytes that come next, and tells how many there were.
using Bytes = std::function<Expected<std::size_t>(std::span<char>)>;

Expected<void> read_voxels(const Bytes& bytes, const NrrdHeader& header, const NumberType& type,
                           Volume& volume) {
  const auto& size = volume.geometry.size;
  const std::size_t voxels = volume.geometry.count(), needed = voxels * type.bytes;
  volume.voxels.reserve(voxels);  // memory is taken as they come
  std::string piece(std::min(needed, type.bytes << 17U), '\0');
  for (std::size_t at = 0; at < voxels;) {
    const std::size_t done = at * type.bytes, asked = std::min(piece.size(), needed - done);
    const auto count = bytes({piece.data(), asked});
    if (!count) return tl::unexpected{count.error()};
    if (*count < asked) {
      return refuse(fmt::format("it ends after {} of {} bytes of voxels: is it truncated?",
                                done + *count, needed));
    }
    for (std::size_t i = 0; i < asked / type.bytes; ++i, ++at) {
      const double value = type.read(piece, i, header.big_endian.value_or(false));
      if (!(std::abs(value) <= 32767)) {
        const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);
        return refuse(fmt::format("voxel ({}, {}, {}) is {:g}, which is no Hounsfield unit",
                                  at % nx, at / nx % ny, at / nx / ny, value));
      }
      volume.voxels.push_back(static_cast<std::int16_t>(std::lround(value)));
    }
  }
  const auto more = bytes({piece.data(), 1});
  if (!more) return tl::unexpected{more.error()};
  if (*more == 0) return {};
  return refuse(fmt::format("more than {} bytes of voxels follow: are its sizes right?", needed));
}

Expected<Volume> volume_from(std::istream& in) {
  auto header = read_nrrd_header(in);
  if (!header) return tl::unexpected{header.error()};
  const NumberType* type = type_named(header->type);
  if (!type) return refuse(fmt::format("the type '{}' is not read", in_part(header->type)));
  if (type->bytes > 1 && !header->big_endian) {
    return refuse(
        fmt::format("its header has no 'endian', and numbers of type '{}' need it", header->type));
  }
  std::optional<GzipReader> packed;
  if (header->is_compressed) packed.emplace(in);
  const Bytes bytes = [&](std::span<char> piece) -> Expected<std::size_t> {
    if (packed) return packed->read(piece);
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    return static_cast<std::size_t>(in.gcount());
  };
  Volume volume{.geometry = header->geometry};
  if (auto read = read_voxels(bytes, *header, *type, volume); !read) {
    return tl::unexpected{read.error()};
  }
  return volume;
}

}  // namespace

Expected<Volume> read_nrrd(const fs::path& file) {
  auto in = open_regular(file);
  if (!in) return refuse(fmt::format("'{}' cannot be read: {}", file.string(), in.error().text));
  auto volume = volume_from(*in);
  if (!volume) return refuse(fmt::format("'{}': {}", file.string(), volume.error().text));
  return volume;
}

Expected<void> write_nrrd(const Volume& volume, const fs::path& file) {
  const auto refused = [&] {
    return refuse(fmt::format("'{}' cannot be written: {}", file.string(), std::strerror(errno)));
  };
  std::ofstream out{file, std::ios::binary};
  if (!out) return refused();
  out << nrrd_header_of(volume.geometry);
  out.write(reinterpret_cast<const char*>(volume.voxels.data()),
            static_cast<std::streamsize>(volume.voxels.size() * sizeof(std::int16_t)));
  if (!out.flush()) return refused();
  return {};
}

}  // namespace armature
