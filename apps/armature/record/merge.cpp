// SPDX-License-Identifier: Apache-2.0
#include "record/merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "armature/recording/hash_chain.hpp"
#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_writer.hpp"
#include "armature/recording/recorded_processes.hpp"
#include "armature/runtime/recording/recorded_description.hpp"
#include "armature/runtime/reporting/draft.hpp"
#include "exit_code.hpp"
#include "record/message_copy.hpp"
#include "record/record.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

/// One of the files, read from its beginning.
class Part {
 public:
  Part(const std::filesystem::path& file, McapWriter& writer)
      : file_{file}, reader_{file, true}, copy_{reader_, writer} {
    step();
    read_origin(reader_);
    if (is_part()) return;
    // In a recording that an older version repaired it stands behind everything.
    whole_ = std::make_unique<McapReader>(file);
    while (whole_->next()) continue;
    read_origin(*whole_);
    if (is_part()) return;
    throw InvalidChoice(fmt::format(
        "'{}' is no part of a run: only what a deployment records of itself (record:) can be "
        "joined",
        file.string()));
  }

  const std::filesystem::path& file() const { return file_; }
  const std::string& run() const { return run_; }
  /// One, or those of a file that was joined before.
  const std::vector<std::string>& processes() const { return processes_; }
  const McapReader& reader() const { return reader_; }
  /// Who has read what the part says of itself, before its first message is copied.
  const McapReader& origin() const { return whole_ ? *whole_ : reader_; }
  /// When its next message was written; nothing: there is none.
  std::optional<Time> next_time() const {
    return next_ ? std::optional{next_->log_time} : std::nullopt;
  }
  /// Copies that message.
  void copy() {
    copy_.write(*next_);
    step();
  }
  /// The metadata of the part that `process` has recorded, complete after its last message.
  McapMetadata metadata_of(const std::string& process) const {
    const McapChain chain = reader_.chain();
    return {.name = std::string{kPartMetadata},
            .values = {
                {"process", process},
                {"file", file_.filename().string()},
                {"sha256", sha256_of_file(file_)},
                {"chain", std::string{word_of(chain.verdict)}},
                {"chain_links", std::to_string(chain.links)},
                {"chain_head", chain.head},
                {"problems", std::to_string(reader_.problems().size())},
                {"first_problem", reader_.problems().empty() ? "" : reader_.problems().front()}}};
  }

 private:
  void step() { next_ = reader_.next(); }
  bool is_part() const { return !run_.empty() && !processes_.empty(); }
  void read_origin(const McapReader& reader) {
    for (const McapMetadata& metadata : reader.metadata()) {
      const auto value = [&](const char* key) {
        const auto found = metadata.values.find(key);
        return found == metadata.values.end() ? std::string{} : found->second;
      };
      if (metadata.name == kDeploymentMetadata) run_ = value("deployment") + " " + value("run");
    }
    processes_ = processes_of(reader.metadata());
  }

  std::filesystem::path file_;
  McapReader reader_;
  std::unique_ptr<McapReader> whole_;
  MessageCopy copy_;
  std::optional<McapMessage> next_;
  std::string run_;
  std::vector<std::string> processes_;
};

using Parts = std::vector<std::unique_ptr<Part>>;

void check_one_run(const Parts& parts) {
  for (const auto& part : parts) {
    for (const auto& other : parts) {
      if (other == part) break;
      if (other->run() != part->run()) {
        throw InvalidChoice(fmt::format("'{}' and '{}' are of different runs",
                                        other->file().string(), part->file().string()));
      }
      for (const std::string& process : part->processes()) {
        if (std::ranges::find(other->processes(), process) == other->processes().end()) continue;
        throw InvalidChoice(fmt::format("'{}' and '{}' are both of process '{}'",
                                        other->file().string(), part->file().string(), process));
      }
    }
  }
}

/// Attachments and metadata, those that several parts have once.
class Surroundings {
 public:
  explicit Surroundings(McapWriter& writer) : writer_{writer} {}

  /// Copies the attachments and metadata that the reader of a part has come by.
  void copy_of(const McapReader& part) {
    for (const McapAttachment& attachment : part.attachments()) {
      if (attached_.emplace(attachment.name, attachment.data).second) writer_.attach(attachment);
    }
    for (const McapMetadata& metadata : part.metadata()) {
      if (told_.emplace(metadata.name, metadata.values).second) writer_.add(metadata);
    }
  }

 private:
  McapWriter& writer_;
  std::set<std::pair<std::string, std::string>> attached_;
  std::set<std::pair<std::string, std::map<std::string, std::string>>> told_;
};

/// Of those that have one, the part whose next message is the earliest.
Part* earliest(const Parts& parts) {
  Part* first = nullptr;
  for (const auto& part : parts) {
    const auto time = part->next_time();
    if (time && (!first || *time < *first->next_time())) first = part.get();
  }
  return first;
}

}  // namespace

JoinedRecording join_recordings(const std::vector<std::filesystem::path>& parts,
                                const std::filesystem::path& out) {
  Draft draft{out, "joining"};  // nobody else may read it
  McapWriter writer{draft.path(), {.library = "armature " ARMATURE_VERSION}};
  Parts open;
  for (const auto& file : parts) open.push_back(std::make_unique<Part>(file, writer));
  check_one_run(open);
  Surroundings surroundings{writer};
  for (const auto& part : open) surroundings.copy_of(part->origin());
  while (Part* part = earliest(open)) part->copy();
  JoinedRecording joined;
  for (const auto& part : open) {
    surroundings.copy_of(part->reader());
    for (const std::string& process : part->processes()) writer.add(part->metadata_of(process));
    joined.processes += part->processes().size();
    for (const std::string& problem : part->reader().problems()) {
      joined.problems.push_back(fmt::format("'{}': {}", part->file().string(), problem));
    }
  }
  writer.close();
  draft.give_name();
  joined.messages = writer.messages();
  joined.bytes = writer.bytes();
  joined.head = to_hex(writer.head());
  return joined;
}

int merge_recordings(const std::vector<std::filesystem::path>& parts,
                     const std::filesystem::path& out, bool force) {
  const HeldFile older = hold_to_replace(out, force);
  const JoinedRecording joined = join_recordings(parts, out);
  for (const std::string& problem : joined.problems) {
    fmt::print(stderr, "armature: {}\n", terminal_text(problem));
  }
  print_out("{}: {} messages of {} processes, {}\n", out.string(), joined.messages,
            joined.processes, megabytes(joined.bytes));
  print_out("last hash {}\n", joined.head);
  return kOk;
}

}  // namespace armature
