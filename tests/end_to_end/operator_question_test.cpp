// SPDX-License-Identifier: Apache-2.0
// Which question an operator has answered: the one that stood before him, whatever the task has
// come to ask meanwhile. The task is played by the test.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/header.hpp"
#include "armature/task/heard_word.hpp"
#include "armature/task/procedure.hpp"
#include "armature/values/temporary_folder.hpp"
#include "asker.hpp"
#include "command.hpp"
#include "tests/dds_domain.hpp"

namespace armature::test {
namespace {

using std::chrono::milliseconds;
using testing::Contains, testing::ElementsAre, testing::IsEmpty, testing::Not;

constexpr std::chrono::seconds kLongEnough{30};

/// The lamp's task: it tells its steps, hears every word and obeys none.
class PlayedTask {
 public:
  PlayedTask(int domain, std::vector<Procedure::Step> steps, Duration clock_ahead = Duration{0})
      : clock_ahead_{clock_ahead},
        procedure_{std::move(steps), false},
        transport_{std::move(*FastDdsTransport::make({.network = {.domain = domain},
                                                      .deployment = "dental_lamp",
                                                      .fingerprint = std::string(64, '0'),
                                                      .now = system_now}))},
        writer_{std::move(*transport_->advertise(
            {"rt/dental_lamp/task/state", &message_type<msg::TaskState>(), QosProfile::state}))},
        reader_{std::move(
            *transport_->subscribe({"rt/dental_lamp/task/operator",
                                    &message_type<msg::OperatorCommand>(), QosProfile::command},
                                   false, [this](const SampleRef& sample) { hear(sample); }))},
        thread_{[this](const std::stop_token& ended) { tell(ended); }} {}

  void enter(std::size_t step) {
    const std::scoped_lock lock{mutex_};
    procedure_.enter(step);
  }
  /// The steps that it was told to begin.
  std::vector<std::string> confirmed() const {
    const std::scoped_lock lock{mutex_};
    return confirmed_;
  }

 private:
  void hear(const SampleRef& sample) {
    const auto& command = *static_cast<const msg::OperatorCommand*>(sample.message());
    const std::scoped_lock lock{mutex_};
    if (command.command_id_() == answered_) return;
    const auto fresh = in_time(command.command_(), stamp_of(command.header_().stamp_()),
                               system_now() + clock_ahead_);
    if (!fresh) {
      answer_ = fresh.error().text;
      answered_ = command.command_id_();
      return;
    }
    const auto heard = procedure_.hear({.word = command.command_(), .step = command.step_()});
    answer_ = heard ? "" : heard.error().text;
    if (heard && *heard == OperatorWord::confirm) confirmed_.push_back(command.step_());
    answered_ = command.command_id_();
  }
  void tell(const std::stop_token& ended) {
    while (!ended.stop_requested()) {
      SampleRef sample = states_.loan();
      auto& state = *static_cast<msg::TaskState*>(sample.mutable_message());
      {
        const std::scoped_lock lock{mutex_};
        write_header(state.header_(), system_now() + clock_ahead_);
        state.answered_(answered_);
        state.answer_() = answer_;
        state.procedure_().resize(procedure_.steps().size());
        for (std::size_t i = 0; i < procedure_.steps().size(); ++i) {
          state.procedure_()[i].name_() = procedure_.steps()[i].name;
          state.procedure_()[i].asks_(procedure_.steps()[i].asks);
          state.procedure_()[i].state_(static_cast<std::uint8_t>(procedure_.state_of(i)));
        }
      }
      sample.mutable_info().published = system_now();
      writer_->offer(sample);
      std::this_thread::sleep_for(milliseconds{5});
    }
  }

  const Duration clock_ahead_;  // of the terminal's
  mutable std::mutex mutex_;
  Procedure procedure_;
  std::vector<std::string> confirmed_;
  std::uint64_t answered_ = 0;
  std::string answer_;
  SamplePool states_{message_type<msg::TaskState>(), 4};
  std::unique_ptr<Transport> transport_;
  std::unique_ptr<RemoteWriter> writer_;
  std::unique_ptr<RemoteReader> reader_;
  std::jthread thread_;
};

constexpr std::size_t kSearch = 1;  // of the lamp's steps

class OperatorQuestionTest : public testing::Test {
 protected:
  explicit OperatorQuestionTest(std::vector<Procedure::Step> steps = {{"light", false},
                                                                      {"search", true},
                                                                      {"alignment", true}},
                                Duration clock_ahead = Duration{0})
      : alignment_{steps.size() - 1}, task_{domain_, std::move(steps), clock_ahead} {
    EXPECT_EQ(mkfifo(keyboard_.c_str(), 0600), 0);
    task_.enter(alignment_);
  }

  std::vector<std::string> operating(std::vector<std::string> more = {}) const {
    std::vector<std::string> command{armature(), "operator",
                                     source_file("configs/dental_lamp.yaml"), "--domain",
                                     std::to_string(domain_)};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  /// With a keyboard that the test types on.
  std::vector<std::string> at_keyboard() const {
    std::vector<std::string> command{"/bin/sh", "-c", "exec \"$@\" < \"$0\"", keyboard_};
    for (const std::string& part : operating()) command.push_back(part);
    return command;
  }

  const int domain_ = unique_dds_domain();
  const TemporaryFolder folder_;
  const std::string keyboard_ = folder_ / "keyboard";
  const std::size_t alignment_;
  PlayedTask task_;
};

TEST_F(OperatorQuestionTest, ATypedConfirmMeansTheStepThatWasShown) {
  Command dialogue{at_keyboard(), {}};
  std::ofstream keyboard{keyboard_};
  ASSERT_TRUE(dialogue.wait_for_out("c(onfirm) 'alignment'", kLongEnough)) << dialogue.err();
  keyboard << "c\n" << std::flush;
  std::this_thread::sleep_for(milliseconds{100});  // it makes sure first who else is the task
  task_.enter(kSearch);
  EXPECT_TRUE(dialogue.wait_for_out("c(onfirm) 'search'", kLongEnough)) << dialogue.err();
  EXPECT_THAT(task_.confirmed(), Not(Contains("search")));
}

TEST_F(OperatorQuestionTest, AQuestionThatHasStoodThereIsAnswered) {
  Command dialogue{at_keyboard(), {}};
  std::ofstream keyboard{keyboard_};
  ASSERT_TRUE(dialogue.wait_for_out("c(onfirm) 'alignment'", kLongEnough)) << dialogue.err();
  task_.enter(kSearch);
  ASSERT_TRUE(dialogue.wait_for_out("c(onfirm) 'search'", kLongEnough)) << dialogue.err();
  std::this_thread::sleep_for(milliseconds{1000});  // twice what it takes to be read
  keyboard << "c\nq\n" << std::flush;
  const CommandResult ended = dialogue.finish(kLongEnough);
  EXPECT_EQ(ended.exit_code, 0) << ended.err;
  EXPECT_THAT(task_.confirmed(), ElementsAre("search")) << ended.err;
}

TEST_F(OperatorQuestionTest, WhoDoesNotSeeTheQuestionNamesTheStep) {
  const CommandResult blind = run_command(operating({"--say", "confirm"}), {}, kLongEnough);
  EXPECT_EQ(blind.exit_code, 1);
  EXPECT_EQ(blind.err,
            "armature: 'confirm' was not said: which of the 2 steps that ask is meant? 'alignment' "
            "waits now: --step 'alignment'\n");
  EXPECT_THAT(task_.confirmed(), IsEmpty());
  const CommandResult named =
      run_command(operating({"--say", "confirm", "--step", "alignment"}), {}, kLongEnough);
  EXPECT_EQ(named.exit_code, 0) << named.err;
  EXPECT_THAT(task_.confirmed(), ElementsAre("alignment"));
}

class OperatorOfOneQuestionTest : public OperatorQuestionTest {
 protected:
  OperatorOfOneQuestionTest() : OperatorQuestionTest{{{"light", false}, {"alignment", true}}} {}
};

TEST_F(OperatorOfOneQuestionTest, NeedsNoNameOfAStep) {
  const CommandResult said = run_command(operating({"--say", "confirm"}), {}, kLongEnough);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_THAT(task_.confirmed(), ElementsAre("alignment"));
}

class OperatorAtAnotherClockTest : public OperatorQuestionTest {
 protected:
  OperatorAtAnotherClockTest()
      : OperatorQuestionTest{{{"light", false}, {"alignment", true}}, -seconds(3600)} {}
};

TEST_F(OperatorAtAnotherClockTest, SaysItsWordsByTheClockOfTheTask) {
  const CommandResult said = run_command(operating({"--say", "confirm"}), {}, kLongEnough);
  EXPECT_EQ(said.exit_code, 0) << said.err;
  EXPECT_THAT(task_.confirmed(), ElementsAre("alignment"));
}

}  // namespace
}  // namespace armature::test
