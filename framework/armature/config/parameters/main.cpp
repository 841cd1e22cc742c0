// SPDX-License-Identifier: Apache-2.0
// armature-parameters PLUGIN_YAML HEADER ID: what armature_add_plugin runs to make a plugin's
// `struct Parameters`.
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
#include <string>

#include "armature/config/document.hpp"
#include "armature/config/parameters/parameters_struct.hpp"

namespace {

std::string text_of(const char* file) {
  std::ostringstream text;
  text << std::ifstream{file}.rdbuf();
  return text.str();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: armature-parameters plugin.yaml header.hpp family/name\n", stderr);
    return 2;
  }
  try {
    armature::config::Problems problems;
    const armature::config::Node manifest = armature::config::parse_file(argv[1]);
    armature::check_plugin(manifest, argv[3], problems);
    const std::string header = armature::parameters_header(manifest, problems);
    problems.throw_if_any();
    if (text_of(argv[2]) == header) return 0;  // nothing is compiled again
    std::ofstream file{argv[2]};
    file << header;
    if (file.flush()) return 0;
    std::fprintf(stderr, "cannot write %s\n", argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
  return 1;
}
