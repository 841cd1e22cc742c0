// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "watch/top_table.hpp"

namespace armature {

/// The terminal, as long as the table has it for itself. There is one at a time.
class TopScreen {
 public:
  enum class Key {
    none,
    other,
    quit,
    help,
    filter,
    up,
    down,
    page_up,
    page_down,
    home,
    end,
    erase,
    enter,
    escape
  };
  struct Pressed {
    Key key = Key::none;
    char letter = 0;  // as it was typed
  };

  /// Throws std::runtime_error where the terminal is not known.
  TopScreen();
  ~TopScreen();
  TopScreen(const TopScreen&) = delete;
  TopScreen& operator=(const TopScreen&) = delete;

  /// Waits at most 0.1 s for a key.
  Pressed pressed() const;
  /// How many lines fit between the title and the last line.
  std::size_t room() const;
  void show(const std::string& title, const std::vector<TopLine>& lines, std::size_t first,
            const std::string& last_line) const;
};

}  // namespace armature
