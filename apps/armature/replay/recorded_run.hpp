// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/recording/mcap_reader.hpp"
#include "armature/runtime/deployment_file/deployment_config.hpp"

namespace armature {

/// The ports of a component as its recording numbers them.
struct RecordedPorts {
  std::vector<std::string> inputs;               // by number
  std::map<std::uint32_t, std::string> outputs;  // by writer
};

/// The recording of one process of a run (`record:` in a deployment), read once from its beginning:
/// activations in the order in which each component had them, and before each the samples that it
/// read and wrote. Holds the samples of the last seconds only.
class RecordedRun {
 public:
  /// `process` is one of recorded_processes(). Throws std::runtime_error for a file that is no such
  /// recording.
  RecordedRun(const std::filesystem::path& file, std::string process);

  const std::filesystem::path& file() const { return file_; }
  const std::string& process() const { return process_; }
  /// What all files of one run have in common.
  const std::string& run() const { return run_; }
  const std::string& processor() const { return processor_; }
  /// The hashes of the plugins' libraries, by plugin.
  const std::map<std::string, std::string>& libraries() const { return libraries_; }
  const std::map<std::string, RecordedPorts>& components() const { return components_; }
  /// The deployment that was recorded, with `--set` assignments made. Throws ConfigError, and
  /// std::runtime_error where the recording does not hold its file.
  DeploymentConfig read_config(const PluginRegistry& plugins,
                               const std::vector<std::string>& assignments,
                               std::vector<std::string>& notes) const;

  /// A call of a component may take so long.
  void keep_for_call(Duration longest);
  /// The samples of `topic` that an input may have been shown are at most so many behind the
  /// newest.
  void keep_at_least(const std::string& topic, std::size_t samples);
  /// The next activation, or nothing at the end of the file, or where activations are missing: no
  /// component can be followed any further then. Throws std::runtime_error.
  std::optional<msg::Activation> next();
  /// A sample of an activation that was returned last; nothing when it was not recorded.
  std::optional<std::span<const std::byte>> sample(std::uint32_t writer,
                                                   std::uint64_t sequence) const;
  /// Whether such a sample was recorded, but so long before the end of the call that read it that
  /// it is not held any more.
  bool was_let_go(std::uint32_t writer, std::uint64_t sequence) const;
  /// [s] when a call was, from the first message of these files on, whose ever that is.
  void count_from_begin_of(const std::vector<std::filesystem::path>& files);
  double seconds_of(const msg::Activation& call) const;
  /// After the last activation: what is wrong with the file. Throws std::runtime_error.
  std::vector<std::string> problems() const;
  /// After the last activation: of components whose last ones were lost, or did not return, what
  /// became of them.
  std::map<std::string, std::string> unrecorded_ends() const;

 private:
  struct Sample {
    std::uint32_t sequence;
    Time at;
    std::vector<std::byte> cdr;
  };

  void read_metadata(const std::filesystem::path& file);
  void read_process(const McapMetadata& metadata);
  bool is_mine(const std::map<std::string, std::string>& metadata) const;
  void read_ports(const McapMetadata& metadata);
  void keep(const McapMessage& message);
  bool is_next(std::uint32_t sequence);

  std::filesystem::path file_;
  std::string deployment_, process_, processor_, run_;
  std::map<std::string, std::string> texts_;  // attachments by name: "robots/arm.yaml"
  std::map<std::string, std::string> files_;  // where they were
  std::map<std::string, std::string> libraries_;
  std::map<std::string, RecordedPorts> components_;
  Duration kept_for_ = seconds(5);               // samples, behind the newest message
  std::map<std::string, std::size_t> min_kept_;  // by topic
  std::uint32_t last_activation_ = 0;
  Time begin_;
  std::vector<std::string> problems_;
  McapReader reader_;
  bool is_read_to_end_ = false;
  std::map<std::uint16_t, std::uint32_t> writers_;       // by channel
  std::map<std::uint32_t, std::deque<Sample>> samples_;  // by writer
  std::map<std::uint32_t, std::uint32_t> let_go_;        // the last sequence, by writer
};

}  // namespace armature
