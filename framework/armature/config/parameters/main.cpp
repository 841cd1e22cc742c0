// SPDX-License-Identifier: Apache-2.0
// armature-parameters PLUGIN_YAML HEADER ID [PORTS_HEADER MESSAGE_HEADERS...]: what
// armature_add_plugin runs to make a plugin's `struct Parameters`, and a component's `struct
// Ports`.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/config/parameters/parameters_struct.hpp"
#include "armature/config/parameters/ports_struct.hpp"

namespace {

std::string text_of(const char* file) {
  std::ostringstream text;
  text << std::ifstream{file}.rdbuf();
  return text.str();
}

/// Leaves a file as it is that holds `text` already: nothing is compiled again.
void write(const char* file, const std::string& text) {
  if (text_of(file) == text) return;
  std::ofstream stream{file};
  stream << text;
  if (!stream.flush()) throw std::runtime_error{std::string{"cannot write "} + file};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fputs(
        "usage: armature-parameters plugin.yaml header.hpp family/name "
        "[ports.hpp message_headers.hpp...]\n",
        stderr);
    return 2;
  }
  try {
    armature::config::Problems problems;
    const armature::config::Node manifest = armature::config::parse_file(argv[1]);
    armature::check_plugin(manifest, argv[3], problems);
    const std::string parameters = armature::parameters_header(manifest, problems);
    const std::vector<std::string> message_headers(argv + std::min(argc, 5), argv + argc);
    const std::string ports =
        argc > 4 ? armature::ports_header(manifest, message_headers, problems) : "";
    problems.throw_if_any();
    write(argv[2], parameters);
    if (argc > 4) write(argv[4], ports);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  return 1;
}
