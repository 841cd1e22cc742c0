// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <string>

#include "armature/recording/hash_chain.hpp"
#include "armature/recording/mcap_reader.hpp"
#include "armature/recording/mcap_writer.hpp"
#include "armature/runtime/recording/recorded_description.hpp"
#include "armature/runtime/reporting/draft.hpp"
#include "exit_code.hpp"
#include "record/message_copy.hpp"
#include "record/record.hpp"
#include "standard_output.hpp"
#include "terminal_text.hpp"

namespace armature {
namespace {

/// Metadata of the new file: which file it was made from, and in what state that was.
McapMetadata repaired_from(const std::filesystem::path& cut, const McapReader& reader) {
  const McapChain chain = reader.chain();
  return {.name = std::string{kRepairedMetadata},
          .values = {{"file", cut.filename().string()},
                     {"sha256", sha256_of_file(cut)},
                     {"chain", std::string{word_of(chain.verdict)}},
                     {"chain_links", std::to_string(chain.links)},
                     {"chain_head", chain.head},
                     {"problems", std::to_string(reader.problems().size())}}};
}

}  // namespace

int repair_recording(const std::filesystem::path& cut, const std::filesystem::path& whole,
                     bool force) {
  std::error_code error;
  if (std::filesystem::equivalent(cut, whole, error)) {
    throw InvalidChoice(fmt::format("'{}' cannot be repaired in place: -o OTHER", cut.string()));
  }
  const HeldFile older = hold_to_replace(whole, force);
  McapReader reader{cut, true};
  Draft draft{whole, "repairing"};  // a full disk takes nothing that was there
  McapWriter writer{draft.path(), {.library = "armature " ARMATURE_VERSION}};
  MessageCopy copy{reader, writer};
  SurroundingsCopy surroundings{reader, writer};
  while (const auto message = reader.next()) {
    surroundings.write();
    copy.write(*message);
  }
  surroundings.write();
  writer.add(repaired_from(cut, reader));
  writer.close();
  draft.give_name();
  for (const std::string& problem : reader.problems()) {
    fmt::print(stderr, "armature: '{}': {}\n", cut.string(), terminal_text(problem));
  }
  print_out("{}: {} messages{}\n", whole.string(), writer.messages(),
            reader.problems().empty() ? ", all of a file that was whole" : "");
  return kOk;
}

}  // namespace armature
