// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>

#include "record/merge.hpp"
#include "record/record.hpp"
#include "replay/publish.hpp"
#include "replay/replay.hpp"
#include "replay/show.hpp"
#include "report/report.hpp"
#include "verbs/option_checks.hpp"
#include "verbs/verbs.hpp"

namespace armature {
namespace {

void add_record(CLI::App& app, Action& action) {
  auto options = std::make_shared<RecordOptions>();
  auto cut = std::make_shared<std::filesystem::path>();
  auto parts = std::make_shared<std::vector<std::filesystem::path>>();
  auto plain = std::make_shared<bool>(false);
  CLI::App* verb = app.add_subcommand(
      "record", "Record topics of running deployments as MCAP: armature record -o run.mcap");
  verb->add_option("-o,--out", options->out, "the file")->required()->check(no_file);
  verb->add_option("topics", options->topics,
                   "only these, a name or the beginning of names: '/dental_lamp/*' (all)")
      ->check(no_pattern);
  verb->add_flag("--force", options->force, "replace a file that is there");
  verb->add_flag("--uncompressed", *plain, "without zstd: more bytes, less processor");
  CLI::Option* repair =
      verb->add_option("--repair", *cut,
                       "write what can be read of this recording, which was cut off, instead")
          ->check(CLI::ExistingFile);
  CLI::Option* merge =
      verb->add_option("--merge", *parts,
                       "join what the processes of a run have recorded of themselves, a file each, "
                       "instead: --merge run.mcap run.vision.mcap")
          ->check(CLI::ExistingFile)
          ->excludes(repair);
  add_watch(*verb, *options);
  for (const char* other : {"topics", "--uncompressed", "--timeout", "--json", "--domain",
                            "--interface", "--peer", "--discovery-server", "--no-shared-memory"}) {
    repair->excludes(other);
    merge->excludes(other);
  }
  verb->get_option("--timeout")->description("end after this many seconds");
  verb->callback([=, &action] {
    options->compress = !*plain;
    action = [=] {
      if (!parts->empty()) return merge_recordings(*parts, options->out, options->force);
      return cut->empty() ? record_topics(*options)
                          : repair_recording(*cut, options->out, options->force);
    };
  });
}

void add_info(CLI::App& app, Action& action) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* verb = app.add_subcommand(
      "info",
      "Tell what is in a recording, and with --verify whether it is whole: armature info run.mcap");
  verb->add_option("recording", options->file, "an MCAP file")
      ->required()
      ->check(CLI::ExistingFile);
  verb->add_flag("--json", options->json, "as JSON");
  CLI::Option* verify = verb->add_flag(
      "--verify", options->verify,
      "read all of it, and tell whether it is as it was written, and how often its topics came");
  verb->add_option("--head", options->head, "and whether this is its last hash, as record told it")
      ->transform(in_small_letters)
      ->check(no_hash)
      ->needs(verify);
  verb->callback([=, &action] { action = [=] { return describe_recording(*options); }; });
}

void add_replay(CLI::App& app, Action& action) {
  auto options = std::make_shared<ReplayOptions>();
  auto publish = std::make_shared<ShowOptions>();
  auto check = std::make_shared<bool>(false);
  CLI::App* verb = app.add_subcommand(
      "replay", "Repeat a recorded run, bit for bit: armature replay run.mcap --check");
  verb->add_option("recordings", options->files,
                   "what a deployment recorded of itself (record:), a file for each process; to "
                   "publish, any one")
      ->required()
      ->check(CLI::ExistingFile);
  verb->add_flag("--check", *check,
                 "repeat every activation and compare all outputs with the recorded ones");
  verb->add_option("--set", options->assignments,
                   "change one value: --set components.motion.ik.plugin=ik/numeric; without "
                   "--check, compare the changed components with the recorded ones")
      ->allow_extra_args(false);
  verb->add_flag("--allow-ulp", options->allow_ulp,
                 "compare what another kind of processor has recorded, too");
  verb->add_option("--prefix", publish->prefix,
                   "without --check and --set, topics are published again, under this name")
      ->capture_default_str();
  verb->add_option("--rate", publish->rate, "so many times as fast")->check(not_positive);
  verb->add_option("--from", publish->from_s, "so many seconds after the beginning")
      ->check(wrong_number)
      ->check(CLI::Range(0.0, 1e9));
  verb->add_flag("--loop", publish->loop, "again and again");
  CLI::Option* monitor = verb->add_flag(
      "--monitor", publish->monitor,
      "show it in a browser and to Foxglove, which plays, pauses and seeks, under its "
      "own names and without DDS");
  for (const char* other : {"--check", "--set", "--prefix"}) monitor->excludes(other);
  add_monitor_address(*verb, publish->server);
  for (const char* option : {"--bind", "--port", "--origin", "--token"}) {
    verb->get_option(option)->needs(monitor);
  }
  add_watch(*verb, *publish);
  for (const char* other : {"--json", "--domain", "--interface", "--peer", "--discovery-server",
                            "--no-shared-memory", "--allow-ulp"}) {
    monitor->excludes(other);
  }
  for (const char* other : {"--prefix", "--rate", "--from", "--loop", "--timeout", "--domain",
                            "--interface", "--peer", "--discovery-server", "--no-shared-memory"}) {
    verb->get_option("--check")->excludes(other);
    verb->get_option("--set")->excludes(other);
  }
  verb->get_option("--timeout")->description("end after this many seconds");
  verb->callback([=, &action] {
    options->json = publish->json;
    publish->file = options->files.front();
    const bool is_publishing = !*check && options->assignments.empty();
    if (is_publishing && options->files.size() > 1) {
      throw CLI::ValidationError("recordings", "only one at a time is published or shown");
    }
    if (is_publishing && options->allow_ulp) {
      throw CLI::ValidationError("--allow-ulp", "nothing is compared without --check or --set");
    }
    if (const std::string wrong = no_prefix(publish->prefix); !wrong.empty()) {
      throw CLI::ValidationError("--prefix", wrong);
    }
    action = [=] {
      if (publish->monitor) return show_recording(*publish);
      if (is_publishing) return publish_recording(*publish);
      return *check ? check_recording(*options) : compare_with_recording(*options);
    };
  });
}

void add_report(CLI::App& app, Action& action) {
  auto options = std::make_shared<ReportOptions>();
  auto without_pictures = std::make_shared<bool>(false);
  CLI::App* verb = app.add_subcommand(
      "report", "Write a recorded run as one page: armature report run.mcap -o report.html");
  verb->add_option("recording", options->recording, "an MCAP file")
      ->required()
      ->check(CLI::ExistingFile);
  verb->add_option("-o,--out", options->out, "the page")->required()->check(no_file);
  verb->add_flag("--without-pictures", *without_pictures, "leave out what the cameras saw");
  verb->add_flag("--force", options->force, "replace a file that is there");
  verb->callback([=, &action] {
    options->pictures = !*without_pictures;
    action = [=] { return print_report(*options); };
  });
}

}  // namespace

void add_record_verbs(CLI::App& app, Action& action) {
  add_record(app, action);
  add_info(app, action);
  add_replay(app, action);
  add_report(app, action);
}

}  // namespace armature
