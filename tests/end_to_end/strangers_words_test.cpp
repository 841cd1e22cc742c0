// SPDX-License-Identifier: Apache-2.0
// What a stranger writes on topics reaches a terminal as text that is shown and not obeyed, and a
// program as JSON, whatever its bytes are.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "armature/messages/rcl_interfaces.hpp"
#include "asker.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using testing::ContainsRegex, testing::HasSubstr, testing::Not;

/// Writes one line on /rosout, again and again, under the name of a deployment's task.
class StrangersLog : public testing::Test {
 protected:
  CommandResult beside(const std::string& text, std::vector<std::string> command) {
    const auto transport = std::move(*FastDdsTransport::make(
        {.network = {.domain = domain_}, .deployment = "stranger", .now = system_now}));
    SamplePool lines{message_type<msg::Log>(), 4};
    const auto writer =
        std::move(*transport->advertise({"rt/rosout", &message_type<msg::Log>(), QosProfile::log}));
    const std::jthread thread{[&](const std::stop_token& ended) {
      while (!ended.stop_requested()) {
        SampleRef sample = lines.loan();
        auto& line = *static_cast<msg::Log*>(sample.mutable_message());
        line.level_(20);
        line.name_("sr1_biopsy.task");
        line.msg_(text);
        sample.mutable_info().published = system_now();
        writer->offer(sample);
        std::this_thread::sleep_for(std::chrono::milliseconds{100});
      }
    }};
    command.insert(command.begin(), armature());
    command.insert(command.end(), {"--timeout", "20", "--domain", std::to_string(domain_)});
    return run_command(command, {}, std::chrono::seconds{40});
  }

  const int domain_ = unique_dds_domain();
};

TEST_F(StrangersLog, IsShownAndNotObeyedAndSaysWhoHasWrittenIt) {
  const CommandResult shown = beside("bell\a \033[2Jred\n12:00:00.000 info    task: ok", {"log"});
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, ContainsRegex("info    sr1_biopsy.task of deployment 'stranger'.*: "
                                       "bell\\\\x07 \\\\x1b\\[2Jred\n {21}12:00:00.000 info"));
  EXPECT_THAT(shown.out, Not(HasSubstr("\033")));
  EXPECT_THAT(shown.out, Not(HasSubstr("\n12:00:00.000")));
}

TEST_F(StrangersLog, IsJsonWhateverItsBytesAre) {
  const CommandResult logged = beside("Eintritt \xFC", {"log", "--json"});
  EXPECT_EQ(logged.exit_code, 0) << logged.err;
  const auto line = nlohmann::json::parse(logged.out.substr(0, logged.out.find('\n')));
  EXPECT_EQ(line["text"], "Eintritt \xEF\xBF\xBD");
  EXPECT_THAT(line["writer"].get<std::string>(), HasSubstr("deployment 'stranger'"));
  const CommandResult echoed = beside("Eintritt \xFC", {"topic", "echo", "/rosout", "-n", "2"});
  EXPECT_EQ(echoed.exit_code, 0) << echoed.err;
  EXPECT_THAT(echoed.out, HasSubstr("\"msg\": \"Eintritt \xEF\xBF\xBD\""));
}

}  // namespace
}  // namespace armature::test
