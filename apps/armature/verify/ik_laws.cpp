// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/mman.h>

#include <algorithm>
#include <new>
#include <stdexcept>

#include "armature/kinds/ik/lines/asking.hpp"
#include "armature/kinds/ik/verify/plugin_subject.hpp"
#include "armature/robot/kinematics/locked_joints.hpp"
#include "bench/allocations.hpp"
#include "exit_code.hpp"
#include "plugin_laws.hpp"
#include "shell_word.hpp"

namespace armature {
namespace {

/// A question in memory that parent and child share: the last one before a crash.
class LastQuestion {
 public:
  LastQuestion() {
    void* memory =
        mmap(nullptr, sizeof(Question), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc{};
    question_ = new (memory) Question{};
  }
  ~LastQuestion() { munmap(question_, sizeof(Question)); }
  LastQuestion(const LastQuestion&) = delete;
  LastQuestion& operator=(const LastQuestion&) = delete;

  void set(const IkGoal& goal, const JointVector& seed, bool redundancy_is_length) {
    *question_ = {goal, seed, redundancy_is_length, true};
  }
  void forget() { *question_ = {}; }
  std::string line(const RobotModel& model) const {
    if (!question_->asked) return "";
    return question_line(model, {.goal = question_->goal,
                                 .seed = question_->seed,
                                 .redundancy_is_length = question_->redundancy_is_length,
                                 .id = {}});
  }

 private:
  struct Question {
    IkGoal goal;
    JointVector seed;
    bool redundancy_is_length = false;
    bool asked = false;
  };
  Question* question_;
};

class IkLawsOfPlugin final : public PluginLaws {
 public:
  explicit IkLawsOfPlugin(const VerifiedPlugin& verified)
      : verified_{verified},
        model_{std::make_shared<const RobotModel>(without_locked_joints(load_arm(verified.arm)))},
        plugins_{verified.search_path},
        plugin_{*plugins_.find(verified.id)},
        params_{params_of(plugin_, verified.options.params)} {
    if (const std::string wrong = wrong_promises(plugin_); !wrong.empty())
      throw InvalidChoice(wrong);
  }

  std::string refusal() override {
    const auto made = plugin_subject(plugins_, plugin_, model_, params_);
    return made ? "" : made.error().text;
  }
  std::vector<LawRun> laws() override {
    std::vector<LawRun> runs;
    for (const IkLaw& law : ik_laws()) {
      runs.push_back({std::string{law.says}, [this, &law] {
                        const IkSubject tried = subject();
                        return check_law(law, tried, tools(*tried.solver));
                      }});
    }
    runs.push_back({std::string{kIkLoadingLaw}, [this] {
                      return check_loading(verified_.search_path, verified_.id, *model_, params_,
                                           std::clamp(verified_.options.poses, 100, 1000));
                    }});
    return runs;
  }

  void forget_question() override { last_.forget(); }
  std::string last_question() const override { return last_.line(*model_); }
  std::string command_for(const std::string& question) const override {
    if (question.empty()) return "";
    const ArmChoice& arm = verified_.arm;
    std::string command = fmt::format("echo {} | {}armature ik --robot {}", shell_word(question),
                                      verified_.environment, shell_word(arm.robot));
    if (!arm.tip.empty()) command += " --tip " + shell_word(arm.tip);
    if (!arm.base.empty()) command += " --base " + shell_word(arm.base);
    const std::string& params = verified_.options.params;
    if (!params.empty()) command += " --params " + shell_word(params);
    return command + " --plugin " + verified_.id;
  }

 private:
  IkSubject subject() {
    auto made = plugin_subject(plugins_, plugin_, model_, params_);
    if (!made) throw std::runtime_error("refused this time: " + made.error().text);
    made->poses = 2 * verified_.options.poses;
    made->edge_poses = verified_.options.poses;
    made->seed = verified_.options.seed;
    return *made;
  }
  IkLawTools tools(const IkSolver& solver) {
    return {.allocations = allocation_counter(),
            .before_solve = [this, is_length = solver.redundancy_is_length()](
                                const IkGoal& goal, const JointVector& seed) {
              last_.set(goal, seed, is_length);
            }};
  }

  VerifiedPlugin verified_;
  std::shared_ptr<const RobotModel> model_;
  PluginRegistry plugins_;
  const PluginManifest& plugin_;
  Params params_;
  LastQuestion last_;
};

}  // namespace

std::unique_ptr<PluginLaws> laws_of_ik(const VerifiedPlugin& verified) {
  return std::make_unique<IkLawsOfPlugin>(verified);
}

}  // namespace armature
