// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "armature/runtime/reporting/write_atomically.hpp"

namespace armature {

struct ReportOptions {
  std::filesystem::path recording, out;
  std::filesystem::path page;  // of `armature monitor`; empty: the one that came with armature
  bool pictures = true;
  bool force = false;  // replace a file that is there
  FileUse use = FileUse::patient_file;
};

/// What became of a page.
struct WrittenReport {
  std::string text;                // "report.html: 25405 of 246236 messages, 12.1 MB"
  std::vector<std::string> notes;  // what whoever made it should know
};

/// Writes one page that needs no other file and no network: that of `armature monitor` with the
/// recording in it, which it opens by itself. What takes room and shows nothing more is left out:
/// see docs/recording.md. Throws InvalidChoice for files that are not as they should be, and
/// std::runtime_error for what cannot be read or written.
WrittenReport write_report(const ReportOptions& options);

/// `armature report`: writes the page and prints what became of it.
int print_report(const ReportOptions& options);

}  // namespace armature
