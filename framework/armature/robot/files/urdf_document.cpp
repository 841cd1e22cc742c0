// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/urdf_document.hpp"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <mutex>
#include <string_view>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/config/source_text.hpp"
#include "armature/robot/files/urdf_words.hpp"
#include "armature/values/utf8.hpp"

namespace armature {
namespace {

using config::ConfigError;
using config::Origin;

/// Keeps what urdfdom has to complain about, which else goes to the terminal.
class Complaints final : public console_bridge::OutputHandler {
 public:
  Complaints() { console_bridge::useOutputHandler(this); }
  ~Complaints() override { console_bridge::restorePreviousOutputHandler(); }
  Complaints(const Complaints&) = delete;
  Complaints& operator=(const Complaints&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) texts.push_back(text);
  }

  std::vector<std::string> texts;

 private:
  std::lock_guard<std::mutex> one_at_a_time_{mutex()};  // the handler is one for the process

  static std::mutex& mutex() {
    static std::mutex only;
    return only;
  }
};

/// Where the document type before the first element begins, if it declares something itself; npos:
/// nowhere.
std::size_t find_declarations(std::string_view text) {
  for (std::size_t at = text.find('<'); at != text.npos; at = text.find('<', at)) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!DOCTYPE")) {
      const std::size_t end = rest.find_first_of("[>");
      return end != rest.npos && rest[end] == '[' ? at : text.npos;
    }
    const bool comment = rest.starts_with("<!--");
    if (!comment && !rest.starts_with("<?")) break;
    at = text.find(comment ? "-->" : "?>", at);
  }
  return text.npos;
}

/// Neither parser reads declarations: tinyxml2 stops at the end of the first.
void refuse_declarations(const std::string& text, const std::string& file) {
  const std::size_t at = find_declarations(text);
  if (at == text.npos) return;
  const auto begin = text.begin(), here = begin + static_cast<std::ptrdiff_t>(at);
  const auto line = static_cast<int>(std::count(begin, here, '\n')) + 1;
  const std::size_t before = text.rfind('\n', at);  // npos + 1 is 0
  throw ConfigError{
      {{Origin{file, line, static_cast<int>(at - (before + 1)) + 1},
        fmt::format("declarations in a document type, such as entities, are not read; run 'xmllint "
                    "--noent --dropdtd {} > resolved.urdf', and name that",
                    file)}}};
}

}  // namespace

UrdfDocument::Places UrdfDocument::places_in(const std::string& text, const std::string& file) {
  tinyxml2::XMLDocument xml;
  if (xml.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS)
    throw ConfigError{
        {{Origin{file, xml.ErrorLineNum(), 1},
          fmt::format("not XML ({})", tinyxml2::XMLDocument::ErrorIDToName(xml.ErrorID()))}}};
  const tinyxml2::XMLElement* robot = xml.FirstChildElement("robot");
  if (!robot)
    throw ConfigError{{{Origin{file, 1, 1},
                        "not a robot description: a URDF file holds one <robot>; of a xacro file "
                        "make one with `xacro`"}}};
  Places places;
  config::Problems problems;
  for (auto* one = robot->FirstChildElement("joint"); one; one = one->NextSiblingElement("joint")) {
    check_joint_words(*one, file, problems);
  }
  problems.throw_if_any();
  for (const char* kind : {"link", "joint"}) {
    for (auto* one = robot->FirstChildElement(kind); one; one = one->NextSiblingElement(kind)) {
      if (const char* name = one->Attribute("name"))
        places.insert_or_assign(name, Origin{file, one->GetLineNum(), 1});
    }
  }
  return places;
}

UrdfDocument UrdfDocument::load(const std::filesystem::path& file, const Origin& named_at) {
  UrdfDocument document;
  document.file_ = file.string();
  const std::string text = config::read_source(file, named_at);
  refuse_declarations(text, document.file_);
  document.places_ = places_in(text, document.file_);

  Complaints complaints;
  try {
    document.model_ = urdf::parseURDF(text);
  } catch (const std::exception& error) {
    complaints.texts.push_back(error.what());
  }
  if (document.model_) return document;
  if (text.find("<xacro:") != std::string::npos) {
    throw ConfigError{
        {{Origin{document.file_, 0, 0},
          fmt::format("a xacro file: run 'xacro {} > arm.urdf', and name that", file.string())}}};
  }
  const std::string all = fmt::format("{}", fmt::join(complaints.texts, "; "));
  Origin place{document.file_, 0, 0};
  for (const auto& [name, origin] : document.places_) {
    const bool named =
        all.find('[' + name + ']') != all.npos || all.find('\'' + name + '\'') != all.npos;
    if (named && (place.line == 0 || origin.line < place.line)) place = origin;
  }
  std::ranges::transform(complaints.texts, complaints.texts.begin(), in_part);
  throw ConfigError{{{place, fmt::format("not a robot description that urdfdom reads: {}",
                                         fmt::join(complaints.texts, "; "))}}};
}

Origin UrdfDocument::joint(const std::string& name) const {
  const auto place = places_.find(name);
  return place == places_.end() ? Origin{file_, 0, 0} : place->second;
}

}  // namespace armature
