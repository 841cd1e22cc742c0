// SPDX-License-Identifier: Apache-2.0
#include "armature/volume/nrrd_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "armature/volume/volume_axes.hpp"

namespace armature {
namespace {

using Fields = std::map<std::string, std::string>;

/// "key: value" lines up to the empty one.
Fields fields_of(std::istream& in) {
  Fields fields;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) break;
    const auto colon = line.find(": ");
    if (line[0] == '#' || colon == std::string::npos) continue;
    fields[line.substr(0, colon)] = line.substr(colon + 2);
  }
  return fields;
}

std::optional<Eigen::Vector3d> three_numbers(std::istream& in) {
  Eigen::Vector3d numbers;
  for (double& number : numbers) {
    std::string word;
    if (!(in >> word)) return std::nullopt;
    char* end = nullptr;
    number = std::strtod(word.c_str(), &end);
    if (*end != '\0') return std::nullopt;
  }
  return numbers;
}

/// "(0.5,0,0)" as "0.5 0 0".
std::istringstream numbers_in(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  return std::istringstream{text};
}

/// What takes the file's axes to LPS, or nothing when the space is another one.
std::optional<Eigen::Vector3d> signs_of(std::string space) {
  std::ranges::transform(space, space.begin(), [](unsigned char c) { return std::tolower(c); });
  if (space == "left-posterior-superior" || space == "lps") return Eigen::Vector3d{1, 1, 1};
  if (space == "right-anterior-superior" || space == "ras") return Eigen::Vector3d{-1, -1, 1};
  if (space == "left-anterior-superior" || space == "las") return Eigen::Vector3d{1, -1, 1};
  return std::nullopt;
}

Expected<VolumeGeometry> geometry_of(const Fields& fields) {
  const auto field = [&](const char* key) {
    const auto found = fields.find(key);
    return found == fields.end() ? std::string{} : found->second;
  };
  if (field("dimension") != "3") return refuse("it has not three axes");
  std::istringstream sizes{field("sizes")};
  VolumeGeometry geometry;
  std::size_t count = 1;
  for (int& size : geometry.size) {
    constexpr int kMost = 4096;  // along an axis
    if (!(sizes >> size) || size < 2 || size > kMost) {
      return refuse(
          fmt::format("its sizes '{}' are not three numbers of 2 to {}", field("sizes"), kMost));
    }
    count *= static_cast<std::size_t>(size);
  }
  constexpr std::size_t kMaxVoxels = std::size_t{1} << 30;
  if (count > kMaxVoxels) return refuse(fmt::format("{} voxels are too many", count));
  const auto signs = signs_of(field("space"));
  if (!signs) {
    return refuse(
        fmt::format("its space is '{}', not left-posterior-superior or "
                    "right-anterior-superior",
                    field("space")));
  }
  auto directions = numbers_in(field("space directions")),
       origin = numbers_in(field("space origin"));
  std::array<Eigen::Vector3d, 3> steps;
  for (Eigen::Vector3d& step : steps) {
    const auto read = three_numbers(directions);
    if (!read) return refuse("it has no three 'space directions'");
    step = 1e-3 * read->cwiseProduct(*signs);
  }
  const auto first = three_numbers(origin);
  if (!first) return refuse("it has no 'space origin'");
  if (auto wrong = set_axes(steps, geometry)) return refuse(std::move(*wrong));
  geometry.origin = 1e-3 * first->cwiseProduct(*signs);
  return geometry;
}

}  // namespace

Expected<NrrdHeader> read_nrrd_header(std::istream& in) {
  std::string magic;
  std::getline(in, magic);
  if (!magic.starts_with("NRRD000")) return refuse("it is no NRRD file");
  const Fields fields = fields_of(in);
  for (const char* key : {"type", "encoding", "dimension", "sizes", "space"}) {
    if (!fields.contains(key)) return refuse(fmt::format("its header has no '{}'", key));
  }
  if (fields.contains("data file") || fields.contains("datafile")) {
    return refuse("its voxels are in another file, which is not read");
  }
  auto geometry = geometry_of(fields);
  if (!geometry) return tl::unexpected{geometry.error()};
  NrrdHeader header{.geometry = *geometry, .type = fields.at("type")};
  const std::string& encoding = fields.at("encoding");
  header.is_compressed = encoding == "gzip" || encoding == "gz";
  if (!header.is_compressed && encoding != "raw") {
    return refuse(fmt::format("its encoding is '{}'; raw and gzip are read", encoding));
  }
  const auto endian = fields.find("endian");
  header.big_endian = endian != fields.end() && endian->second == "big";
  return header;
}

std::string nrrd_header_of(const VolumeGeometry& geometry) {
  const auto& size = geometry.size;
  std::string directions;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = 1e3 * geometry.spacing[axis] * geometry.direction.col(axis);
    directions += fmt::format(" ({},{},{})", step.x(), step.y(), step.z());
  }
  const Eigen::Vector3d origin = 1e3 * geometry.origin;
  return fmt::format(
      "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: {} {} {}\n"
      "space directions:{}\nkinds: domain domain domain\nendian: little\nencoding: raw\n"
      "space origin: ({},{},{})\n\n",
      size[0], size[1], size[2], directions, origin.x(), origin.y(), origin.z());
}

}  // namespace armature
