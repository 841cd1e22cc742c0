// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/plugins/elf_section.hpp"

#include <elf.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace armature {
namespace {

constexpr std::uint64_t kMaxSectionBytes = 4 << 20;

class ElfFile {
 public:
  explicit ElfFile(const std::filesystem::path& file)
      : stream_{file, std::ios::binary | std::ios::ate} {
    if (stream_) size_ = static_cast<std::uint64_t>(stream_.tellg());
  }
  explicit operator bool() const { return static_cast<bool>(stream_); }

  bool read(std::uint64_t offset, void* to, std::uint64_t bytes) {
    if (offset > size_ || bytes > size_ - offset) return false;
    stream_.seekg(static_cast<std::streamoff>(offset));
    return static_cast<bool>(
        stream_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes)));
  }
  bool text(const Elf64_Shdr& section, std::string& out) {
    if (section.sh_type == SHT_NOBITS || section.sh_size > kMaxSectionBytes) return false;
    out.resize(section.sh_size);
    return read(section.sh_offset, out.data(), section.sh_size);
  }

 private:
  std::ifstream stream_;
  std::uint64_t size_ = 0;
};

}  // namespace

Expected<std::map<std::string, std::string>> read_elf_sections(
    const std::filesystem::path& file, const std::vector<std::string_view>& names) {
  ElfFile elf{file};
  if (!elf) return refuse(std::string{"cannot read it: "} + std::strerror(errno));
  Elf64_Ehdr header;
  if (!elf.read(0, &header, sizeof header) || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 ||
      header.e_ident[EI_CLASS] != ELFCLASS64 || header.e_shentsize != sizeof(Elf64_Shdr)) {
    return refuse("not a 64-bit ELF library");
  }
  std::vector<Elf64_Shdr> sections(header.e_shnum);
  std::string section_names;
  if (!elf.read(header.e_shoff, sections.data(), sections.size() * sizeof(Elf64_Shdr)) ||
      header.e_shstrndx >= sections.size() ||
      !elf.text(sections[header.e_shstrndx], section_names)) {
    return refuse("a damaged ELF library: its section table cannot be read");
  }
  std::map<std::string, std::string> found;
  for (const Elf64_Shdr& section : sections) {
    if (section.sh_name >= section_names.size()) continue;
    const std::string name = section_names.c_str() + section.sh_name;
    if (std::find(names.begin(), names.end(), name) == names.end()) continue;
    std::string text;
    if (!elf.text(section, text)) return refuse("a damaged ELF library: section " + name);
    found[name] = text.c_str();
  }
  return found;
}

}  // namespace armature
