// SPDX-License-Identifier: Apache-2.0
#include "reproduce/reproduce.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "armature/config/document.hpp"
#include "armature/config/problems.hpp"
#include "armature/runtime/plugins/running_component.hpp"
#include "armature/runtime/reporting/output_folder.hpp"
#include "exit_code.hpp"
#include "readable_json.hpp"
#include "reproduce/papers.hpp"
#include "reproduce/report.hpp"
#include "standard_output.hpp"
#include "verbs/shipped_configs.hpp"

namespace armature {
namespace {

const reproduce::Paper& paper_named(const std::string& name) {
  std::vector<std::string> names;
  for (const reproduce::Paper& paper : reproduce::papers()) {
    if (paper.name == name) return paper;
    names.emplace_back(paper.name);
  }
  throw InvalidChoice(fmt::format("there is no paper {}{}", config::in_quotes(name),
                                  config::did_you_mean(name, names)));
}

}  // namespace

int reproduce_paper(const ReproduceOptions& options) {
  const reproduce::Paper& paper = paper_named(options.paper);
  if (options.out) prepare_output_folder(*options.out);
  name_crashing_components();
  const config::Node file = config::parse_file(shipped_folder("papers") / paper.file);
  const reproduce::Declaration declaration = reproduce::read_declaration(file);
  reproduce::Results results;
  paper.compute(reproduce::Numbers{declaration.numbers}, !options.is_short, results);
  const reproduce::Judgement judgement = reproduce::judge(declaration, results, !options.is_short);
  if (options.json) {
    print_out("{}\n", readable(reproduce::to_json(declaration, judgement)));
  } else {
    print_out("{}", reproduce::to_text(declaration, judgement));
  }
  if (options.out) {
    const auto files = reproduce::write_files(*options.out, declaration, judgement, results);
    if (!options.json) print_out("{} files in {}\n", files.size(), options.out->string());
  }
  return judgement.failed() == 0 ? kOk : kFailed;
}

}  // namespace armature
