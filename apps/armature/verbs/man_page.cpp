// SPDX-License-Identifier: Apache-2.0
#include "verbs/man_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>

namespace armature {
namespace {

/// Text that roff prints as it is: '-' is a minus as it is typed, and a line that begins with '.'
/// or
/// '\'' no request.
std::string escaped(std::string_view text) {
  std::string roff;
  for (const char c : text) {
    const bool begins = roff.empty() || roff.back() == '\n';
    if (begins && (c == '.' || c == '\'')) roff += "\\&";
    if (c == '\\') {
      roff += "\\e";
    } else if (c == '-') {
      roff += "\\-";
    } else {
      roff += c;
    }
  }
  return roff;
}

std::string usage_of(const std::string& path, const Verb& verb) {
  std::string roff = fmt::format(".B {}\n[OPTIONS]", escaped(path));
  for (const VerbOption& word : verb.positionals) {
    const std::string name = escaped(word.names.back());
    roff += word.required ? " " + name : " [" + name + "]";
  }
  return roff + (verb.verbs.empty() ? "" : " SUBCOMMAND") + "\n";
}

std::string options_of_page(const std::vector<VerbOption>& options) {
  std::string roff;
  for (const VerbOption& option : options) {
    roff += fmt::format(
        ".TP\n\\fB{}\\fR{}\n{}\n", escaped(fmt::format("{}", fmt::join(option.names, ", "))),
        option.type.empty() ? "" : " " + escaped(option.type), escaped(option.description));
  }
  return roff;
}

/// Every verb that does something, one section each.
std::string commands_below(const std::string& path, const Verb& verb) {
  std::string roff;
  for (const Verb& below : verb.verbs) {
    const std::string whole = path + " " + below.name;
    if (below.verbs.empty()) {
      roff += fmt::format(".SS \"{}\"\n{}\n.PP\n{}{}{}", escaped(whole), escaped(below.description),
                          usage_of(whole, below), options_of_page(below.positionals),
                          options_of_page(below.options));
    } else {
      roff += commands_below(whole, below);
    }
  }
  return roff;
}

}  // namespace

std::string man_page(const Verb& program, const std::string& version) {
  const std::string summary = program.description.substr(0, program.description.find('\n'));
  std::string upper = program.name;
  for (char& c : upper) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  return fmt::format(
      ".TH {} 1 \"\" \"{} {}\"\n.nh\n.ad l\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}.SH "
      "DESCRIPTION\n{}\n"
      ".SH OPTIONS\n{}.SH COMMANDS\n{}",
      upper, program.name, version, program.name, escaped(summary), usage_of(program.name, program),
      escaped(program.description), options_of_page(program.options),
      commands_below(program.name, program));
}

}  // namespace armature
