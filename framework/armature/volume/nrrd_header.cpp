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

#include "armature/values/utf8.hpp"
#include "armature/volume/volume_axes.hpp"

namespace armature {
namespace {

struct Field {
  std::string name, value;
  int line = 0;
};

/// By their names in small letters without blanks: "data file" may be written "datafile".
using Fields = std::map<std::string, Field>;

std::string in_small_letters(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string key_of(const std::string& name) {
  std::string key = in_small_letters(name);
  std::erase(key, ' ');
  return key;
}

std::string place_of(const Field& field) {
  return fmt::format("line {}: its '{}' is '{}'", field.line, in_part(field.name),
                     in_part(field.value));
}

/// The lines of a header. A file that is none may be a line of any length, or have no end of them.
class HeaderLines {
 public:
  explicit HeaderLines(std::istream& in) : in_{in} {}

  /// The next one without what ends it; empty at the end of the file, too.
  Expected<std::string> next() {
    ++number_;
    std::string line;
    for (int c = in_.get(); c != std::istream::traits_type::eof() && c != '\n'; c = in_.get()) {
      if (left_-- == 0) {
        return refuse(fmt::format("line {}: its header is longer than {} bytes", number_, kMost));
      }
      line += static_cast<char>(c);
    }
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
  }
  /// Of the line that was read last; the first one is 1.
  int number() const { return number_; }

 private:
  static constexpr std::size_t kMost = std::size_t{16} << 20U;

  std::istream& in_;
  std::size_t left_ = kMost;
  int number_ = 0;
};

/// "name: value" lines up to the empty one, behind the first line of the file. "key:=value" says
/// nothing of the voxels.
Expected<Fields> fields_of(HeaderLines& lines) {
  Fields fields;
  while (true) {
    const auto next = lines.next();
    if (!next) return tl::unexpected{next.error()};
    if (next->empty()) break;
    const std::string& line = *next;
    const int number = lines.number();
    const auto colon = line.find(':');
    const bool is_field = colon != std::string::npos && line.substr(colon).starts_with(": ");
    if (line[0] == '#' || (!is_field && line.find(":=") != std::string::npos)) continue;
    if (!is_field) {
      return refuse(fmt::format("line {}: '{}' is neither 'field: value' nor 'key:=value'", number,
                                in_part(line)));
    }
    Field field{line.substr(0, colon), line.substr(colon + 2), number};
    const auto [before, is_new] = fields.emplace(key_of(field.name), field);
    if (is_new) continue;
    return refuse(fmt::format("line {}: '{}' is there twice, in line {} as well: which one counts?",
                              number, in_part(field.name), before->second.line));
  }
  return fields;
}

/// Fields that would give voxels another place or value, and are not read. Nothing is ignored that
/// changes what a volume means.
Expected<void> refuse_what_is_not_read(const Fields& fields) {
  if (const auto file = fields.find("datafile"); file != fields.end()) {
    return refuse(fmt::format("line {}: its voxels are in another file, which is not read",
                              file->second.line));
  }
  for (const char* skip : {"byteskip", "lineskip"}) {
    const auto found = fields.find(skip);
    if (found == fields.end() || found->second.value == "0") continue;
    return refuse(place_of(found->second) +
                  "; only voxels that begin right behind the header are read");
  }
  for (const char* scale : {"oldmin", "oldmax"}) {
    const auto found = fields.find(scale);
    if (found == fields.end()) continue;
    return refuse(place_of(found->second) +
                  "; only voxels that are Hounsfield units themselves are read");
  }
  return {};
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
std::optional<Eigen::Vector3d> signs_of(const std::string& written) {
  const std::string space = in_small_letters(written);
  if (space == "left-posterior-superior" || space == "lps") return Eigen::Vector3d{1, 1, 1};
  if (space == "right-anterior-superior" || space == "ras") return Eigen::Vector3d{-1, -1, 1};
  if (space == "left-anterior-superior" || space == "las") return Eigen::Vector3d{1, -1, 1};
  return std::nullopt;
}

/// Lengths are millimetres, said or not.
Expected<void> check_units(const Fields& fields) {
  const auto units = fields.find("spaceunits");
  if (units == fields.end()) return {};
  std::string text = in_small_letters(units->second.value);
  std::ranges::replace(text, '"', ' ');
  std::istringstream words{text};
  int count = 0;
  bool all_mm = true;
  for (std::string word; words >> word; ++count) {
    all_mm = all_mm && (word == "mm" || word == "millimeter" || word == "millimeters" ||
                        word == "millimetre" || word == "millimetres");
  }
  if (all_mm && count == 3) return {};
  return refuse(place_of(units->second) + "; three times \"mm\" is read");
}

Expected<VolumeGeometry> geometry_of(const Fields& fields) {
  const auto field = [&](const char* key) {
    const auto found = fields.find(key);
    return found == fields.end() ? std::string{} : found->second.value;
  };
  if (field("dimension") != "3") return refuse("it has not three axes");
  std::istringstream sizes{field("sizes")};
  VolumeGeometry geometry;
  std::size_t count = 1;
  for (int& size : geometry.size) {
    constexpr int kMost = 4096;  // along an axis
    if (!(sizes >> size) || size < 2 || size > kMost) {
      return refuse(fmt::format("its sizes '{}' are not three numbers of 2 to {}",
                                in_part(field("sizes")), kMost));
    }
    count *= static_cast<std::size_t>(size);
  }
  if (auto wrong = too_many_voxels(count)) return refuse(std::move(*wrong));
  const auto signs = signs_of(field("space"));
  if (!signs) {
    return refuse(
        fmt::format("its space is '{}', not left-posterior-superior or "
                    "right-anterior-superior",
                    in_part(field("space"))));
  }
  auto directions = numbers_in(field("spacedirections")), origin = numbers_in(field("spaceorigin"));
  std::array<Eigen::Vector3d, 3> steps;
  for (Eigen::Vector3d& step : steps) {
    const auto read = three_numbers(directions);
    if (!read) return refuse("it has no three 'space directions'");
    step = 1e-3 * read->cwiseProduct(*signs);
  }
  const auto first = three_numbers(origin);
  if (!first) return refuse("it has no 'space origin'");
  if (!first->allFinite()) {
    return refuse(place_of(fields.at("spaceorigin")) + ", which is no place");
  }
  if (auto wrong = set_axes(steps, geometry)) return refuse(std::move(*wrong));
  if (auto wrong = set_origin(1e-3 * first->cwiseProduct(*signs), geometry)) {
    return refuse(std::move(*wrong));
  }
  return geometry;
}

}  // namespace

Expected<NrrdHeader> read_nrrd_header(std::istream& in) {
  constexpr std::string_view kMagic = "NRRD000";
  std::string magic(kMagic.size(), '\0');
  in.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  if (magic != kMagic) return refuse("it is no NRRD file");
  HeaderLines lines{in};
  if (const auto version = lines.next(); !version) return tl::unexpected{version.error()};
  const auto fields = fields_of(lines);
  if (!fields) return tl::unexpected{fields.error()};
  for (const char* key : {"type", "encoding", "dimension", "sizes", "space"}) {
    if (!fields->contains(key)) return refuse(fmt::format("its header has no '{}'", key));
  }
  if (auto read = refuse_what_is_not_read(*fields); !read) return tl::unexpected{read.error()};
  if (auto read = check_units(*fields); !read) return tl::unexpected{read.error()};
  auto geometry = geometry_of(*fields);
  if (!geometry) return tl::unexpected{geometry.error()};
  NrrdHeader header{.geometry = *geometry, .type = fields->at("type").value};
  const std::string& encoding = fields->at("encoding").value;
  header.is_compressed = encoding == "gzip" || encoding == "gz";
  if (!header.is_compressed && encoding != "raw") {
    return refuse(fmt::format("its encoding is '{}'; raw and gzip are read", in_part(encoding)));
  }
  const auto endian = fields->find("endian");
  if (endian == fields->end()) return header;
  const std::string order = in_small_letters(endian->second.value);
  header.big_endian = order == "big";
  if (order != "big" && order != "little") {
    return refuse(place_of(endian->second) + ", not big or little");
  }
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
