// SPDX-License-Identifier: Apache-2.0
#include "watch/top_screen.hpp"

#define NCURSES_NOMACROS
#include <curses.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "standard_output.hpp"

namespace armature {
namespace {

constexpr int kWait_ms = 100;

/// Curses' pairs of colours, by tone.
constexpr short pair_of(Tone tone) { return static_cast<short>(static_cast<int>(tone) + 1); }

void line(int row, const std::string& text, int attributes) {
  move(row, 0);
  attrset(attributes);
  addnstr(text.c_str(), std::max(getmaxx(stdscr), 1));
  if (attributes & A_REVERSE) {
    for (int column = static_cast<int>(text.size()); column < getmaxx(stdscr); ++column) addch(' ');
  }
}

int attributes_of(const TopLine& line) {
  const bool plain = !line.tone || !has_colors() || std::getenv("NO_COLOR");
  const bool title = !line.text.starts_with(' ');
  if (!plain) return COLOR_PAIR(pair_of(*line.tone)) | A_BOLD;
  return title || line.tone ? A_BOLD : A_NORMAL;
}

}  // namespace

TopScreen::TopScreen() {
  if (!newterm(nullptr, standard_output(), stdin)) {
    const char* term = std::getenv("TERM");
    throw std::runtime_error("the terminal '" + std::string{term ? term : ""} +
                             "' is not known here; set TERM, or take `armature top -n 1`");
  }
  cbreak();
  noecho();
  curs_set(0);
  keypad(stdscr, TRUE);
  timeout(kWait_ms);
  if (!has_colors()) return;
  start_color();
  use_default_colors();
  init_pair(pair_of(Tone::good), COLOR_GREEN, -1);
  init_pair(pair_of(Tone::doubtful), COLOR_YELLOW, -1);
  init_pair(pair_of(Tone::bad), COLOR_RED, -1);
}

TopScreen::~TopScreen() { endwin(); }

TopScreen::Pressed TopScreen::pressed() const {
  constexpr int kEscape = 27, kDelete = 127;
  switch (const int key = getch()) {
    case ERR: return {};
    case KEY_F(10): return {Key::quit};
    case 'q': return {Key::quit, 'q'};
    case KEY_F(1): return {Key::help};
    case KEY_F(4): return {Key::filter};
    case '/':
    case '\\': return {Key::filter, static_cast<char>(key)};
    case KEY_UP: return {Key::up};
    case KEY_DOWN: return {Key::down};
    case KEY_PPAGE: return {Key::page_up};
    case KEY_NPAGE: return {Key::page_down};
    case KEY_HOME: return {Key::home};
    case KEY_END: return {Key::end};
    case KEY_BACKSPACE:
    case kDelete:
    case '\b': return {Key::erase};
    case '\n':
    case '\r':
    case KEY_ENTER: return {Key::enter};
    case kEscape: return {Key::escape};
    default: return {Key::other, key >= ' ' && key < kDelete ? static_cast<char>(key) : '\0'};
  }
}

std::size_t TopScreen::room() const {
  return static_cast<std::size_t>(std::max(getmaxy(stdscr) - 2, 1));
}

void TopScreen::show(const std::string& title, const std::vector<TopLine>& lines, std::size_t first,
                     const std::string& last_line) const {
  erase();
  line(0, title, A_REVERSE);
  const std::size_t end = std::min(lines.size(), first + room());
  for (std::size_t i = first; i < end; ++i) {
    line(static_cast<int>(i - first) + 1, lines[i].text, attributes_of(lines[i]));
  }
  line(getmaxy(stdscr) - 1, last_line, A_REVERSE);
  refresh();
}

}  // namespace armature
