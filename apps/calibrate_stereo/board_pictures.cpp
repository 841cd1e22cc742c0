// SPDX-License-Identifier: Apache-2.0
#include "board_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "folder_pictures.hpp"

namespace armature {
namespace {

using pictures::GrayPicture;

void check_size(BoardPictures& found, const GrayPicture& picture, const std::string& name) {
  if (found.width == 0) {
    found.width = picture.width;
    found.height = picture.height;
  }
  if (picture.width == found.width && picture.height == found.height) return;
  throw std::runtime_error(
      fmt::format("{}: has {} x {} pixels, the first picture has {} x {}; a calibration is of one "
                  "size",
                  name, picture.width, picture.height, found.width, found.height));
}

/// Which pair has one of these pictures already, or "": a copy tells nothing new, and one picture
/// is not seen at two moments.
std::string shown_before(const std::vector<stereo::BoardView>& views,
                         const stereo::BoardView& view) {
  const auto earlier = std::ranges::find_if(views, [&](const stereo::BoardView& other) {
    return other.left == view.left || other.right == view.right;
  });
  if (earlier == views.end()) return "";
  return fmt::format("{}: a picture of it is that of {}", view.name, earlier->name);
}

}  // namespace

BoardPictures read_board_pictures(const std::filesystem::path& left,
                                  const std::filesystem::path& right,
                                  const chessboard::BoardShape& shape) {
  pictures::FolderPictures folders{{.left = left, .right = right, .skip = true}};
  if (!folders.remark().empty()) fmt::print(stderr, "left out: {}\n", folders.remark());
  BoardPictures found;
  for (const pictures::FilePair& pair : folders.files()) {
    ++found.pairs;
    stereo::BoardView view{.left = {}, .right = {}, .name = pair.left.filename()};
    std::string why;
    for (const auto& [file, corners] :
         {std::pair{&pair.left, &view.left}, {&pair.right, &view.right}}) {
      const auto picture = pictures::read_picture(*file);
      if (!picture) {
        why = picture.error().text;
        break;
      }
      check_size(found, *picture, file->string());
      // The right camera's board begins where the left one's does.
      const Eigen::Vector2d towards =
          view.left.empty() ? Eigen::Vector2d{1, 1} : view.left.back() - view.left.front();
      auto board =
          chessboard::find_board(picture->pixels, picture->width, picture->height, shape, towards);
      if (!board) {
        why = fmt::format("{}: {}", file->string(), board.error().text);
        break;
      }
      *corners = std::move(*board);
    }
    if (why.empty()) why = shown_before(found.views, view);
    if (!why.empty()) {
      fmt::print(stderr, "left out: {}\n", why);
      continue;
    }
    found.views.push_back(std::move(view));
  }
  return found;
}

}  // namespace armature
