// SPDX-License-Identifier: Apache-2.0
#include "sweep/sweep.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "armature/runtime/reporting/output_folder.hpp"
#include "exit_code.hpp"
#include "inspect/plugins.hpp"
#include "isolated.hpp"
#include "progress.hpp"
#include "readable_json.hpp"
#include "standard_output.hpp"
#include "sweep/finished_runs.hpp"
#include "sweep/lockstep_run.hpp"
#include "sweep/spread.hpp"
#include "sweep/sweep_report.hpp"

namespace armature {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using sweep::RunKey;

/// The files with the values of one combination.
struct Combination {
  std::vector<std::string> variation;
  DeploymentSource source;
  DeploymentConfig config;  // with seed 0, for what does not depend on it
  std::string name;         // of its runs, whatever the seed
};

struct Job {
  const Combination* combination;
  RunKey key;
};

std::string run_once(const Job& job, PluginRegistry& plugins) {
  DeploymentSource source = job.combination->source;
  source.assignments.push_back(fmt::format("seed={}", job.key.seed));
  return lockstep_report(read_for_lockstep(source, plugins), plugins);
}

/// A process that crashed or hung has a report, too.
Json report_of(const Isolated& outcome) {
  if (outcome.fault.empty()) return Json::parse(outcome.result);
  return Json{{"status", outcome.timed_out ? sweep::kTimedOut : sweep::kCrashed},
              {"reason", outcome.fault}};
}

/// Runs what is missing.
void run(const std::vector<Job>& jobs, const SweepOptions& options, PluginRegistry& plugins,
         sweep::FinishedRuns& finished) {
  Progress progress{"runs"};
  std::size_t done = 0;
  const std::size_t at_once =
      options.jobs > 0 ? static_cast<std::size_t>(options.jobs) : processors();
  isolated_each(
      jobs.size(), at_once, options.timeout_s,
      [&](std::size_t i) { return run_once(jobs[i], plugins); },
      [&](std::size_t i, const Isolated& outcome) {
        finished.add(jobs[i].key, report_of(outcome));
        progress.of(++done, jobs.size());
      });
}

bool same_goals(const DeploymentConfig& a, const DeploymentConfig& b) {
  const auto same = [](const SweepGoal& x, const SweepGoal& y) {
    return x.metric == y.metric && x.statistic == y.statistic && x.at_least == y.at_least &&
           x.at_most == y.at_most && x.share_of == y.share_of;
  };
  return std::ranges::equal(a.goals, b.goals,
                            [](const Goal& x, const Goal& y) {
                              return x.metric == y.metric && x.limit == y.limit;
                            }) &&
         std::ranges::equal(a.sweep_goals, b.sweep_goals, same);
}

/// Two that are one deployment would be counted twice; one table has one set of goals.
void check(const std::vector<Combination>& combinations, bool is_pooled) {
  std::set<std::string> fingerprints;
  for (const Combination& one : combinations) {
    if (!fingerprints.insert(one.config.fingerprint).second) {
      throw InvalidChoice(fmt::format("--vary: '{}' is the same deployment as another combination",
                                      fmt::join(one.variation, ", ")));
    }
    if (is_pooled && !same_goals(one.config, combinations.front().config)) {
      throw InvalidChoice("--pool: the combinations have not the same goals");
    }
  }
}

/// A file as it is now, but for its place.
std::string state_of(const fs::path& file) {
  std::error_code none;
  return fmt::format("{} {} {}\n", file.filename().string(), fs::file_size(file, none),
                     fs::last_write_time(file, none).time_since_epoch().count());
}

/// Names the build by its programs and libraries: what another one told is not this one's.
std::string build_of(const PluginRegistry& plugins) {
  std::set<fs::path> files{"/proc/self/exe"};
  std::ifstream maps{"/proc/self/maps"};
  for (std::string line; std::getline(maps, line);) {
    const auto path = line.find('/');
    if (path != std::string::npos && line.find("libarmature_") != std::string::npos) {
      files.insert(line.substr(path));
    }
  }
  for (const PluginManifest& plugin : plugins.plugins()) files.insert(plugin.file);
  std::string text;
  for (const fs::path& file : files) text += state_of(file);
  return text;
}

/// The files that parameters name, and what lies in folders that they name: of those the
/// fingerprint has the names only.
std::string data_of(const Params& params, const PluginManifest& plugin) {
  std::string text;
  for (const ParamSpec& spec : plugin.params) {
    if (spec.type != ParamSpec::Type::file) continue;
    const std::string named = params.file(spec.name);
    if (named.empty()) continue;
    std::set<fs::path> files{named};
    std::error_code none;
    for (const auto& entry : fs::directory_iterator{named, none}) files.insert(entry.path());
    for (const fs::path& file : files) text += state_of(file);
  }
  return text;
}

std::string data_of(const DeploymentConfig& config) {
  std::string text;
  for (const ComponentConfig& component : config.components) {
    text += data_of(component.params, *component.manifest);
    for (const SlotConfig& slot : component.slots) text += data_of(slot.params, *slot.manifest);
  }
  return text;
}

/// Names all that a combination's runs come from, but for their seeds.
std::string name_of(const DeploymentConfig& config, const std::string& build) {
  const std::size_t others = std::hash<std::string>{}(build + data_of(config));
  return fmt::format("{}/{:016x}", config.fingerprint, others);
}

std::vector<Combination> combinations_of(const SweepOptions& options,
                                         const PluginRegistry& plugins) {
  const std::string build = build_of(plugins);
  std::vector<Combination> all;
  for (const std::vector<std::string>& variation : sweep::combinations(options.vary)) {
    DeploymentSource source = options.source;
    source.assignments.insert(source.assignments.end(), variation.begin(), variation.end());
    DeploymentSource without_seed = source;
    without_seed.assignments.push_back("seed=0");
    all.push_back({variation, std::move(source), read_for_lockstep(without_seed, plugins), ""});
    all.back().name = name_of(all.back().config, build);
  }
  return all;
}

}  // namespace

int sweep_deployment(const SweepOptions& options) {
  PluginRegistry plugins;
  tell_warnings(plugins);
  const std::vector<Combination> combinations = combinations_of(options, plugins);
  check(combinations, options.pool);
  if (std::ranges::any_of(combinations, [](const Combination& combination) {
        return combination.config.record.has_value();
      })) {
    fmt::print(stderr, "armature: 'record:' is left out, a sweep records none of its runs\n");
  }
  const auto key_of = [](const Combination& combination, std::uint64_t seed) {
    return RunKey{combination.name, seed};
  };
  if (options.out) prepare_output_folder(*options.out);
  sweep::FinishedRuns finished{options.out ? std::optional{*options.out / "runs.jsonl"}
                                           : std::nullopt};
  std::vector<Job> missing;
  std::size_t known = 0;
  for (const Combination& combination : combinations) {
    for (const std::uint64_t seed : options.seeds) {
      const RunKey key = key_of(combination, seed);
      if (finished.find(key)) {
        ++known;
      } else {
        missing.push_back({&combination, key});
      }
    }
  }
  if (known > 0) {
    fmt::print(stderr, "armature: {} of {} runs are in {} already\n", known, known + missing.size(),
               options.out->string());
  }
  run(missing, options, plugins, finished);

  std::vector<sweep::RunSpread> spreads;
  std::vector<sweep::SeedReport> reports;
  for (const Combination& combination : combinations) {
    if (!options.pool) reports.clear();
    for (const std::uint64_t seed : options.seeds) {
      reports.push_back({seed, finished.find(key_of(combination, seed))});
    }
    if (options.pool) continue;
    spreads.push_back(sweep::spread_of(reports, combination.config, combination.variation));
  }
  if (options.pool) {
    spreads.push_back(sweep::spread_of(reports, combinations.front().config, {}));
    spreads.back().is_pooled = combinations.size() > 1;
  }
  if (options.out) sweep::write_files(*options.out, spreads);
  Json json = Json::array();
  for (const sweep::RunSpread& spread : spreads) {
    if (options.json) {
      json.push_back(to_json(spread));
    } else {
      print_out("{}", to_text(spread));
    }
  }
  if (options.json) print_out("{}\n", readable(json));
  return std::ranges::all_of(spreads, &sweep::RunSpread::is_ok) ? kOk : kFailed;
}

}  // namespace armature
