// SPDX-License-Identifier: Apache-2.0
// armature-messages: what armature_add_messages runs to make C++ classes of IDL files.
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "armature/messages/generator/message_code.hpp"

namespace {

namespace fs = std::filesystem;

constexpr const char* kUsage =
    "usage: armature-messages OUT HEADER_FOLDER ALIAS|- [-I FOLDER=HEADER_FOLDER]... FILE.idl...\n"
    "writes OUT/HEADER_FOLDER/FILE.hpp of every file, and OUT/HEADER_FOLDER/messages.cpp\n";

/// What has not changed stays as old as it is: nothing is compiled again.
void write(const fs::path& path, const std::string& text) {
  std::ostringstream there;
  there << std::ifstream{path}.rdbuf();
  if (there.str() == text) return;
  fs::create_directories(path.parent_path());
  std::ofstream file{path};
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

void generate(const std::vector<std::string>& arguments) {
  const fs::path out = arguments[0];
  const std::string &header_folder = arguments[1], alias = arguments[2] == "-" ? "" : arguments[2];
  std::vector<armature::IdlFolder> folders;
  std::vector<fs::path> paths;
  for (std::size_t i = 3; i < arguments.size(); ++i) {
    if (arguments[i] != "-I") {
      paths.emplace_back(arguments[i]);
    } else if (const auto at =
                   i + 1 < arguments.size() ? arguments[++i].rfind('=') : std::string::npos;
               at != std::string::npos) {
      folders.push_back({arguments[i].substr(0, at), arguments[i].substr(at + 1)});
    } else {
      throw std::runtime_error(kUsage);
    }
  }
  armature::IdlFiles files{header_folder, folders};
  for (const fs::path& path : paths) {
    if (const auto read = files.read(path); !read) throw std::runtime_error(read.error().text);
  }
  std::vector<armature::IdlFile> own;
  for (const armature::IdlFile& file : files.all()) {
    if (!file.header.starts_with(header_folder + "/")) continue;
    write(out / file.header, armature::message_header(file, alias));
    own.push_back(file);
  }
  write(out / header_folder / "messages.cpp", armature::message_source(own));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  try {
    generate({argv + 1, argv + argc});
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
