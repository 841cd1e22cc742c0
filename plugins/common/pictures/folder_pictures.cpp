// SPDX-License-Identifier: Apache-2.0
#include "folder_pictures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "armature/config/problems.hpp"
#include "armature/runtime/plugins/setup_error.hpp"
#include "armature/values/regular_file.hpp"

namespace armature::pictures {
namespace {

namespace fs = std::filesystem;
using config::in_quotes;

constexpr double kMaxTime_s = 9e9;  // 64 bits of nanoseconds have 9.2e9 s
constexpr double kMaxSpan_s = 1e6;
constexpr std::array<std::string_view, 8> kEndings{".png", ".jpg", ".jpeg", ".pgm",
                                                   ".ppm", ".bmp", ".tif",  ".tiff"};

bool is_picture(const fs::path& file) {
  std::string ending = file.extension();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return std::ranges::find(kEndings, ending) != kEndings.end();
}

std::size_t count_digits(std::string_view text) {
  const auto end = std::ranges::find_if_not(text, [](unsigned char c) { return std::isdigit(c); });
  return static_cast<std::size_t>(end - text.begin());
}

/// img2 stands before img10.
struct ByNumber {
  bool operator()(std::string_view a, std::string_view b) const {
    const std::string_view whole_a = a, whole_b = b;
    while (!a.empty() && !b.empty()) {
      const std::size_t of_a = count_digits(a), of_b = count_digits(b);
      if (of_a == 0 || of_b == 0) {
        if (a.front() != b.front()) return a.front() < b.front();
        a.remove_prefix(1);
        b.remove_prefix(1);
        continue;
      }
      std::string_view number_a = a.substr(0, of_a), number_b = b.substr(0, of_b);
      number_a.remove_prefix(std::min(number_a.find_first_not_of('0'), of_a - 1));
      number_b.remove_prefix(std::min(number_b.find_first_not_of('0'), of_b - 1));
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
      if (number_a != number_b) return number_a < number_b;
      a.remove_prefix(of_a);
      b.remove_prefix(of_b);
    }
    if (a.empty() != b.empty()) return a.empty();
    return whole_a < whole_b;
  }
};
using Files = std::map<std::string, fs::path, ByNumber>;  // by what both of a pair share

/// The pictures of one side. `word` begins their names, or may.
Files files_of(const fs::path& folder, std::string_view word, bool word_is_needed) {
  std::error_code error;
  Files files;
  for (fs::directory_iterator at{folder, error}, end; !error && at != end; at.increment(error)) {
    std::string name = at->path().filename();
    std::error_code unknown;  // a link that leads nowhere is no file
    if (!is_picture(at->path()) || !at->is_regular_file(unknown)) continue;
    const bool begins = name.starts_with(word);
    if (word_is_needed && !begins) continue;
    const auto [same, is_new] = files.emplace(begins ? name.substr(word.size()) : name, at->path());
    if (is_new) continue;
    std::string other = same->second.filename();
    if (other < name) std::swap(name, other);
    throw SetupError(fmt::format(
        "{}: '{}' and '{}' of the folder '{}' are one name behind the word '{}'; take one of them "
        "away",
        word, name, other, folder.string(), word));
  }
  if (error) {
    throw SetupError(fmt::format("{}: the folder '{}' cannot be read: {}", word, folder.string(),
                                 error.message()));
  }
  if (files.empty()) {
    throw SetupError(fmt::format(
        "{}: the folder '{}' has no pictures{} ({})", word, folder.string(),
        word_is_needed ? fmt::format(" whose names begin with '{}'", word) : std::string{},
        fmt::join(kEndings, ", ")));
  }
  return files;
}

/// "a.png, b.png, c.png and 4 more".
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 3;
  const std::vector<std::string> shown(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(kShown, names.size())));
  const std::string more =
      names.size() > kShown ? fmt::format(" and {} more", names.size() - kShown) : "";
  return fmt::format("{}{}", fmt::join(shown, ", "), more);
}

/// Throws for two pairs of one time, and for times that cannot be seconds. `pairs` are sorted.
void check_times(const std::vector<FilePair>& pairs, const fs::path& file) {
  const double span_s = to_seconds(pairs.back().at - pairs.front().at);
  if (span_s > kMaxSpan_s) {
    throw SetupError(fmt::format(
        "{}: '{}' and '{}' are {:g} s apart, more than {:g} s; seconds are asked for: are these "
        "nanoseconds?",
        file.string(), pairs.front().left.filename().string(),
        pairs.back().left.filename().string(), span_s, kMaxSpan_s));
  }
  const auto twice = std::ranges::adjacent_find(pairs, {}, &FilePair::at);
  if (twice != pairs.end()) {
    throw SetupError(fmt::format("{}: '{}' and '{}' have the same time", file.string(),
                                 twice->left.filename().string(),
                                 std::next(twice)->left.filename().string()));
  }
}

}  // namespace

FolderPictures::FolderPictures(const Options& options) : interval_{options.interval} {
  find_pairs(options);
  if (!options.timestamps.empty()) {
    read_times(options.timestamps);
    return;
  }
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    pairs_[i].at = Time{} + interval_ * static_cast<std::int64_t>(i);
  }
}

void FolderPictures::find_pairs(const Options& options) {
  std::error_code error;
  const bool shared = fs::equivalent(options.left, options.right, error);
  const Files left = files_of(options.left, "left", shared);
  const Files right = files_of(options.right, "right", shared);
  std::vector<std::string> alone;
  for (const auto& [key, file] : left) {
    if (const auto partner = right.find(key); partner != right.end()) {
      pairs_.push_back({.left = file, .right = partner->second, .at = {}});
    } else {
      alone.push_back(file);
    }
  }
  for (const auto& [key, file] : right) {
    if (!left.contains(key)) alone.push_back(file);
  }
  left_out_ = alone.size();
  if (!alone.empty()) remark_ = "without a partner on the other side: " + listed(alone);
  if (!alone.empty() && (!options.skip || pairs_.empty())) {
    throw SetupError(fmt::format(
        "{}; the names of a pair are the same behind 'left' and 'right'{}", remark_,
        options.skip ? ", and no two files are one" : "; bad_pictures: skip leaves them out"));
  }
}

void FolderPictures::read_times(const fs::path& file) {
  constexpr std::size_t kMaxBytes = std::size_t{64} << 20U;
  auto text = bytes_of_regular(file, kMaxBytes);
  if (!text) {
    throw SetupError(
        fmt::format("timestamps: '{}' cannot be read: {}", file.string(), text.error().text));
  }
  std::istringstream stream{std::move(*text)};
  std::map<std::string, double> times;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::istringstream words{line};
    std::string name, time, more;
    if (!(words >> name) || name.starts_with('#')) continue;
    const auto wrong = [&](const std::string& what) {
      throw SetupError(
          fmt::format("{}:{}: {}; a line is 'NAME SECONDS'", file.string(), number, what));
    };
    if (!(words >> time) || words >> more) wrong(in_quotes(line) + " has not two words");
    double at = 0;
    const auto [end, error] = std::from_chars(time.data(), time.data() + time.size(), at);
    if (error != std::errc{} || end != time.data() + time.size() || !std::isfinite(at)) {
      wrong(in_quotes(time) + " is no time in seconds");
    }
    if (std::abs(at) > kMaxTime_s) {
      wrong(
          fmt::format("{} is beyond {:g} s, as nanoseconds would be", in_quotes(time), kMaxTime_s));
    }
    if (!times.emplace(name, at).second) wrong(in_quotes(name) + " has a time already");
  }
  for (FilePair& pair : pairs_) {
    const auto found = times.find(pair.left.filename());
    if (found == times.end()) {
      throw SetupError(fmt::format("{}: has no time for '{}'; write a line '{} SECONDS'",
                                   file.string(), pair.left.filename().string(),
                                   pair.left.filename().string()));
    }
    pair.at = Time{} + seconds(found->second - times.at(pairs_.front().left.filename()));
  }
  std::ranges::stable_sort(pairs_, {}, &FilePair::at);
  check_times(pairs_, file);
}

std::optional<TimedPicture> FolderPictures::next() {
  if (next_ >= 2 * pairs_.size()) return std::nullopt;
  const FilePair& pair = pairs_[next_ / 2];
  const Side side = next_ % 2 == 0 ? Side::left : Side::right;
  ++next_;
  return TimedPicture{.side = side,
                      .stamp = pair.at,
                      .published = pair.at,
                      .picture = read_picture(side == Side::left ? pair.left : pair.right)};
}

Duration FolderPictures::last_interval() const {
  if (pairs_.size() < 2) return interval_;
  return pairs_.back().at - pairs_[pairs_.size() - 2].at;
}

}  // namespace armature::pictures
