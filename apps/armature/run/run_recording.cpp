// SPDX-License-Identifier: Apache-2.0
#include "run/run_recording.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <exception>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "armature/recording/recorded_processes.hpp"
#include "armature/values/json_text.hpp"
#include "exit_code.hpp"
#include "record/merge.hpp"
#include "record/record.hpp"
#include "report/report.hpp"
#include "shell_word.hpp"

namespace armature {
namespace {

/// Whether a file has enough of the recording of a process to be joined with others.
bool is_part(const std::filesystem::path& file) {
  try {
    return !recorded_processes(file).front().empty();
  } catch (
      const std::exception&) {  // it is not there, or its process died before it wrote anything
    return false;
  }
}

/// The files as words of a line for a shell.
std::string words_of(const std::vector<std::filesystem::path>& files) {
  std::string words;
  for (const std::filesystem::path& file : files) words += " " + shell_word(file.string());
  return words;
}

/// What is joined at the end of a run: the recordings of this host's processes. Those that are
/// missing are `missing`.
std::vector<std::filesystem::path> parts_of(const std::filesystem::path& recording,
                                            const DeploymentConfig& config,
                                            std::vector<std::string>& missing) {
  std::vector<std::filesystem::path> parts{recording};
  for (const std::string& name : config.processes()) {
    if (name == kMainProcess || config.host_of(name) != kMainHost) continue;
    std::filesystem::path part = RecordConfig::part_of(recording, name);
    if (is_part(part)) {
      parts.push_back(std::move(part));
    } else {
      missing.push_back(fmt::format(
          "the recording of process '{}' is missing, or cannot be read: {}", name, part.string()));
    }
  }
  return parts;
}

/// When a recording begins, as its name says it. The simulated clock begins at 0.
Time named_after(const DeploymentConfig& config, Time time) {
  return config.simulated ? SystemClock{}.now() : time;
}

void check_files(const DeploymentConfig& config, Time start,
                 const std::function<bool(const std::string& process)>& is_meant) {
  if (!config.record || config.record->around_faults) return;
  config::Problems problems;
  for (const std::string& name : config.processes()) {
    if (!is_meant(name)) continue;
    const std::filesystem::path file = config.record->file_of(name, named_after(config, start));
    std::error_code none;
    if (std::filesystem::file_size(file, none) == 0 || none) continue;
    problems.add(config.record->origin,
                 fmt::format("the recording '{}' is there already: move it, or let the name say "
                             "the time, run-%Y%m%d-%H%M%S.mcap",
                             file.string()));
  }
  problems.throw_if_any();
}

/// Names what stays on other hosts, which are not reached from here, and what joins it.
void tell_other_hosts(const std::filesystem::path& recording, const DeploymentConfig& config,
                      Console& console) {
  for (const std::string& host : config.hosts()) {
    if (host == kMainHost) continue;
    std::vector<std::filesystem::path> files{recording.filename()};
    for (const std::string& name : config.processes()) {
      if (config.host_of(name) != host) continue;
      files.push_back(RecordConfig::part_of(recording.filename(), name));
    }
    if (files.size() == 1) continue;
    const std::vector<std::string> there{files.begin() + 1, files.end()};
    console.line("runtime",
                 fmt::format("host '{}' has recorded {} there; brought here, it is joined by: "
                             "armature record --merge{} -o whole.mcap",
                             host, fmt::join(there, " and "), words_of(files)));
  }
}

}  // namespace

void check_recordings(const DeploymentConfig& config, Time start) {
  check_files(config, start,
              [&](const std::string& process) { return config.host_of(process) == kMainHost; });
}

void check_recording(const DeploymentConfig& config, const std::string& process, Time start) {
  check_files(config, start, [&](const std::string& name) { return name == process; });
}

std::optional<std::filesystem::path> begin_recording(Deployment& deployment,
                                                     const std::string& process, Time start) {
  const DeploymentConfig& config = deployment.config();
  if (!config.record) return std::nullopt;
  const auto name_at = [&config, process](Time time) {
    const std::filesystem::path file = config.record->file_of(process, named_after(config, time));
    std::error_code error;
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
    if (error) {
      throw std::runtime_error(fmt::format("cannot make the folder '{}': {}",
                                           file.parent_path().string(), error.message()));
    }
    return file;
  };
  if (config.record->around_faults) {
    deployment.record(config.record->file, name_at);
    return std::nullopt;
  }
  std::filesystem::path file = name_at(start);
  deployment.record(file, name_at);
  return file;
}

void remove_recordings(const std::filesystem::path& recording, const DeploymentConfig& config) {
  for (const std::string& name : config.processes()) {
    if (config.host_of(name) != kMainHost) continue;
    remove_older(name == kMainProcess ? recording : RecordConfig::part_of(recording, name));
  }
}

std::filesystem::path page_file(const std::filesystem::path& folder) {
  return folder / "report.html";
}

void remove_older(const std::filesystem::path& file) {
  std::error_code none;
  const auto older = std::filesystem::symlink_status(file, none);
  if (std::filesystem::is_regular_file(older)) std::filesystem::remove(file, none);
}

void record_for_page(DeploymentConfig& config, RunOptions& options) {
  std::string file = std::filesystem::absolute(*options.report / kRecordingForPage).string();
  for (std::size_t at = 0; (at = file.find('%', at)) != std::string::npos; at += 2) {
    file.insert(at, 1, '%');  // the name of a recording may say the time
  }
  options.records_for_page = true;
  config.record = RecordConfig{.file = file, .thin = true, .origin = {}};
  for (const std::string& process : config.processes()) {
    const std::filesystem::path older = config.record->file_of(process, Time{});
    const HeldFile held = hold_to_replace(older, true);  // `armature record` may be writing it
    remove_older(older);
  }
  const nlohmann::json record{{"file", file}, {"thin", true}};
  options.source.assignments.push_back("record=" + json_text(record));
}

bool joined(const std::filesystem::path& recording, const DeploymentConfig& config,
            Console& console) {
  std::vector<std::string> missing;
  const auto parts = parts_of(recording, config, missing);
  for (const std::string& part : missing) console.tell(part);
  tell_other_hosts(recording, config, console);
  if (parts.size() < 2) return missing.empty();
  constexpr std::uintmax_t kTakesSeconds = 200'000'000;
  std::uintmax_t bytes = 0;
  std::error_code gone;
  for (const auto& part : parts) bytes += std::filesystem::file_size(part, gone);
  if (bytes > kTakesSeconds) {
    console.line("runtime", fmt::format("joining the recordings of {} processes, {}", parts.size(),
                                        megabytes(bytes)));
  }
  try {
    const JoinedRecording joined = join_recordings(parts, recording);
    std::error_code none;
    for (const auto& part : parts) {
      if (part != recording) std::filesystem::remove(part, none);
    }
    console.line("runtime", fmt::format("joined: {}: {} messages of {} processes, {}, last hash {}",
                                        recording.string(), joined.messages, parts.size(),
                                        megabytes(joined.bytes), joined.head));
    for (const std::string& problem : joined.problems) console.tell(problem);
    return missing.empty();
  } catch (const std::exception& error) {
    console.tell(
        fmt::format("the recordings of the processes were not joined: {}; join them where "
                    "there is room: armature record --merge{} -o whole.mcap",
                    error.what(), words_of(parts)));
    return false;
  }
}

bool page_written(const std::optional<std::filesystem::path>& recording,
                  const std::filesystem::path& folder, Console& console) {
  if (!recording) {
    console.tell(
        "the run records only what happens around a trouble (around_faults_s), so its report has "
        "no page");
    return true;
  }
  try {
    const WrittenReport page = write_report(
        {.recording = *recording, .out = page_file(folder), .force = true, .use = FileUse::report});
    console.line("runtime", "page of the run: " + page.text);
    for (const std::string& note : page.notes) console.tell(note);
  } catch (const InvalidChoice& refusal) {  // the run is what it was without its page
    console.tell(refusal.what());
  } catch (const std::exception& error) {
    console.tell(error.what());
    return false;
  }
  return true;
}

}  // namespace armature
