// SPDX-License-Identifier: Apache-2.0
#include "armature/robot/files/urdf_words.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace armature {
namespace {

using config::did_you_mean, config::spelling_hint;
using config::Origin;
using Names = std::vector<std::string>;

struct Element {
  std::string name;
  Names attributes;
  bool once = true;  // a second one is not read
};

/// What a <joint> may hold (wiki.ros.org/urdf/XML/joint).
const std::vector<Element>& elements() {
  static const std::vector<Element> kElements{
      {"origin", {"xyz", "rpy"}},
      {"parent", {"link"}},
      {"child", {"link"}},
      {"axis", {"xyz"}},
      {"limit", {"lower", "upper", "effort", "velocity"}},
      {"mimic", {"joint", "multiplier", "offset"}},
      {"dynamics", {"damping", "friction"}, false},
      {"calibration", {"rising", "falling", "reference_position"}, false},
      {"safety_controller",
       {"k_velocity", "k_position", "soft_lower_limit", "soft_upper_limit"},
       false}};
  return kElements;
}

bool is_of_a_namespace(std::string_view name) { return name.find(':') != name.npos; }

/// "; did you mean ..." of a word that is not known, empty of one that is or is another's.
std::string hint(std::string_view word, const Names& known, bool others_may_be) {
  if (std::ranges::find(known, word) != known.end() || is_of_a_namespace(word)) return "";
  return others_may_be ? spelling_hint(word, known) : did_you_mean(word, known);
}

/// Says what is wrong in one joint.
class JointWords {
 public:
  JointWords(const tinyxml2::XMLElement& joint, const std::string& file, config::Problems& problems)
      : joint_{joint}, file_{file}, problems_{problems} {}

  void check() {
    attributes_of(joint_, "joint", {"name", "type"});
    Names seen, known;
    for (const Element& element : elements()) known.push_back(element.name);
    for (auto* child = joint_.FirstChildElement(); child; child = child->NextSiblingElement()) {
      const std::string name = child->Name();
      const auto element = std::ranges::find(elements(), name, &Element::name);
      if (element == elements().end()) {
        if (const std::string text = hint(name, known, true); !text.empty()) {
          add(child->GetLineNum(),
              fmt::format("has an element <{}>, which is none of URDF{}", name, text));
        }
        continue;
      }
      attributes_of(*child, name, element->attributes);
      const bool second = std::ranges::find(seen, name) != seen.end();
      if (second && element->once) {
        add(child->GetLineNum(),
            fmt::format("has a second <{}>, and only the first is read", name));
      }
      seen.push_back(name);
    }
  }

 private:
  void attributes_of(const tinyxml2::XMLElement& element, const std::string& name,
                     const Names& known) {
    const bool others_may_be = name != "origin";
    for (auto* one = element.FirstAttribute(); one; one = one->Next()) {
      const std::string text = hint(one->Name(), known, others_may_be);
      if (text.empty()) continue;
      add(one->GetLineNum(),
          fmt::format("has '{}' in its <{}>, which is none of URDF{}", one->Name(), name, text));
    }
  }
  void add(int line, const std::string& what) {
    const char* name = joint_.Attribute("name");
    problems_.add(Origin{file_, line, 1}, fmt::format("joint '{}' {}", name ? name : "", what));
  }

  const tinyxml2::XMLElement& joint_;
  const std::string& file_;
  config::Problems& problems_;
};

}  // namespace

void check_joint_words(const tinyxml2::XMLElement& joint, const std::string& file,
                       config::Problems& problems) {
  JointWords{joint, file, problems}.check();
}

}  // namespace armature
