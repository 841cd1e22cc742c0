// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace armature {

/// How Ctrl-C, Ctrl-\, `kill` and a terminal that is closed (but under nohup) end a run: every
/// signal that would end the process and is no crash, so that no arm is left while it moves.
namespace end_signals {

/// What the handlers say when they end the process themselves. Before any of them is set.
struct Words {
  bool json = false;                    // an object on standard output
  std::filesystem::path report_file{};  // report.json, or empty
};
void say(const Words& words);
/// From when on the report's file can be written.
void allow_report();
bool report_allowed();
/// From when on the result stands: no signal writes another one in its place.
void result_told();
bool is_result_told();

/// Nothing runs yet, and constructing components (a landmark model is read) cannot be told to stop:
/// the process ends at once, and says so.
void end_before_start();
/// The first one stops the run in order. The third of SIGINT, SIGTERM and SIGQUIT, which people
/// send, ends the process at once, and says so. A pipe whose reader is gone does not end it.
void stop_in_order();

/// Sets the handlers again where something in this process has taken them since: its name
/// ("SIGINT"), of the first, or "".
std::string take_back();

/// "interrupted", "terminated", "the terminal was closed" or "ended by SIGQUIT", once there has
/// been a signal.
std::optional<std::string> cause();
/// How many there have been.
int count();

}  // namespace end_signals
}  // namespace armature
