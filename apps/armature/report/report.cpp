// SPDX-License-Identifier: Apache-2.0
#include "report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/recording/hash_chain.hpp"
#include "armature/runtime/recording/page_rate.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "armature/values/json_text.hpp"
#include "date_text.hpp"
#include "exit_code.hpp"
#include "record/record.hpp"
#include "record/repaired.hpp"
#include "report/reduced_recording.hpp"
#include "standard_output.hpp"
#include "verbs/shipped_configs.hpp"

namespace armature {
namespace {

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8 | (j < count ? static_cast<unsigned char>(bytes[i + j]) : 0U);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += j <= count ? kDigits[group >> (18 - 6 * j) & 63] : '=';
    }
  }
  return text;
}

/// As the value of an attribute in quotes.
std::string escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&': escaped += "&amp;"; break;
      case '"': escaped += "&quot;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

std::string date_of(Time time) {
  return date_text(utc(time.ns / 1'000'000'000), "%Y-%m-%d %H:%M:%S UTC");
}

std::string_view state_of(const RunContents& contents) {
  switch (contents.chain.verdict) {
    case McapChain::Verdict::whole: return contents.is_whole ? "whole and unchanged" : "not whole";
    case McapChain::Verdict::cut: return "cut off";
    case McapChain::Verdict::changed: return "changed after it was written";
    case McapChain::Verdict::none: break;
  }
  return contents.is_whole ? "without a chain of hashes" : "not whole";
}

/// The page moves the arm by what viewers are told, and what nobody reads is not recorded.
bool shows_moving_arm(const RunContents& contents) {
  const auto has = [&](const char* topic) { return contents.topics.contains(topic); };
  return !has("/robot_description") || (has("/joint_states") && has("/tf"));
}

/// What the page tells of itself: a name and a text, in this order.
nlohmann::ordered_json provenance(const ReportOptions& options, const RunContents& contents,
                                  const Reduced& kept) {
  nlohmann::ordered_json told = nlohmann::ordered_json::array();
  const auto add = [&](std::string_view name, std::string text) {
    if (!text.empty()) told.push_back({name, std::move(text)});
  };
  const auto of_deployment = [&](const char* name) {
    const auto found = contents.deployment.find(name);
    return found == contents.deployment.end() ? std::string{} : found->second;
  };
  add("Recording", options.recording.filename().string());
  add("SHA-256", sha256_of_file(options.recording));
  add("Last hash", contents.chain.head);
  add("Checked", std::string{state_of(contents)});
  for (const std::string& repair : contents.repairs) add("Incomplete", repair);
  add("Recorded", fmt::format("{}, {:.1f} s", date_of(contents.first),
                              to_seconds(contents.last - contents.first)));
  add("Deployment", of_deployment("deployment"));
  add("Version", of_deployment("version"));
  add("Fingerprint", of_deployment("fingerprint"));
  add("Clock", of_deployment("clock"));
  add("In this page",
      fmt::format("{} of {} messages: about {} a second of each writer of a topic, {} of a "
                  "camera{}",
                  kept.messages, contents.messages + contents.thinned, kMaxPageHz,
                  kMaxPagePictureHz, options.pictures ? "" : "; without pictures"));
  add("Page by", "armature " ARMATURE_VERSION);
  return told;
}

/// A recording with joints shall show the arm that they are of.
bool lacks_arm(const RunContents& contents) {
  return contents.topics.contains("/joint_states") &&
         !contents.topics.contains("/robot_description");
}

/// What whoever made the page should know.
std::vector<std::string> notes_on(const ReportOptions& options, const RunContents& contents) {
  std::vector<std::string> notes;
  const auto note = [&](std::string_view text) {
    notes.push_back(fmt::format("'{}' {}", options.recording.string(), text));
  };
  if (!contents.is_whole || contents.chain.verdict == McapChain::Verdict::changed) {
    note(fmt::format("is {}: the page says so", state_of(contents)));
  }
  for (const std::string& repair : contents.repairs) {
    note(fmt::format("is incomplete: {}; the page says so", repair));
  }
  if (!shows_moving_arm(contents)) {
    note(
        "has no /joint_states or no /tf: the page does not show how the arm moved (name both "
        "under record: topics)");
  }
  if (lacks_arm(contents)) {
    note("has no /robot_description: the page shows no arm (name it under record: topics)");
  }
  return notes;
}

}  // namespace

WrittenReport write_report(const ReportOptions& options) {
  std::error_code error;
  if (std::filesystem::equivalent(options.recording, options.out, error)) {
    throw InvalidChoice(fmt::format("'{}' is the recording itself", options.out.string()));
  }
  const HeldFile older = hold_to_replace(options.out, options.force);
  std::string page =
      bytes_of(options.page.empty() ? shipped_folder("monitor") / "index.html" : options.page);
  constexpr std::string_view kScript = "<script type=\"module\">";
  const std::size_t place = page.find(kScript);
  if (place == std::string::npos) throw std::runtime_error{"the page of the monitor has no script"};

  const RunContents contents = read_contents(options.recording);
  if (contents.messages == 0) {
    throw InvalidChoice(fmt::format("'{}' has no messages", options.recording.string()));
  }
  const Reduced kept = reduced(options.recording, contents, options.pictures);
  page.insert(place,
              fmt::format("<script type=\"application/octet-stream;base64\" id=\"recording\" "
                          "data-name=\"{}\" data-told=\"{}\" data-figures=\"{}\">{}</script>\n",
                          escaped(options.recording.filename().string()),
                          escaped(json_text(provenance(options, contents, kept))),
                          escaped(contents.figures), base64(kept.bytes)));
  write_atomically(options.out, page, options.use);
  return {.text = fmt::format("{}: {} of {} messages, {:.3f} MB", options.out.string(),
                              kept.messages, contents.messages + contents.thinned,
                              1e-6 * static_cast<double>(page.size())),
          .notes = notes_on(options, contents)};
}

int print_report(const ReportOptions& options) {
  const WrittenReport written = write_report(options);
  for (const std::string& note : written.notes) fmt::print(stderr, "armature: {}\n", note);
  print_out("{}\n", written.text);
  return kOk;
}

}  // namespace armature
