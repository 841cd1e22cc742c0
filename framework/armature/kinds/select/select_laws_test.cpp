// SPDX-License-Identifier: Apache-2.0
// The laws of selectors find those that break them, and only the laws that are broken.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "armature/kinds/select/laws.hpp"

namespace armature {
namespace {

using testing::ElementsAre, testing::IsEmpty, testing::IsSupersetOf;
using Spoil = std::function<void(std::vector<JointVector>&)>;

/// A joint that turns round several times, and a slide.
RobotModel winder() {
  const auto joint = [](const char* name, Joint::Type type, double limit) {
    return Joint{.name = name,
                 .type = type,
                 .lower = -limit,
                 .upper = limit,
                 .max_velocity = 1,
                 .max_acceleration = 1};
  };
  return {{"winder",
           RobotModel::Convention::standard,
           {joint("turn", Joint::Type::revolute, 8), joint("slide", Joint::Type::prismatic, 10)},
           {{"tool", 1, Eigen::Isometry3d::Identity()}},
           FrameId{0},
           {},
           {}}};
}

/// Takes the first branch within limits of every waypoint; what it answers is spoilt.
class First : public BranchSelector {
 public:
  First(const RobotModel& model, Spoil spoil) : model_{model}, spoil_{std::move(spoil)} {}
  Expected<std::vector<JointVector>> choose(const JointVector& start,
                                            std::span<const IkBranches> waypoints) const override {
    if (auto wrong = invalid_input(model_, start, waypoints)) return refuse(*wrong);
    std::vector<JointVector> chosen;
    for (const IkBranches& branches : waypoints) {
      const auto q = first(chosen.empty() ? start : chosen.back(), branches);
      if (!q) {
        return refuse(
            fmt::format("waypoint {} of {}: no branch", chosen.size() + 1, waypoints.size()));
      }
      chosen.push_back(*q);
    }
    spoil_(chosen);
    return chosen;
  }

 private:
  std::optional<JointVector> first(const JointVector& before, const IkBranches& branches) const {
    for (const IkBranch& branch : branches) {
      JointVector q = branch.q;
      if (unwind(model_, before, q)) return q;
    }
    return std::nullopt;
  }

  RobotModel model_;
  Spoil spoil_;
};

/// Looks at nothing, and stays where it is when there is no way.
class Credulous : public First {
 public:
  using First::First;
  Expected<std::vector<JointVector>> choose(const JointVector& start,
                                            std::span<const IkBranches> waypoints) const override {
    auto chosen = First::choose(start, waypoints);
    if (!chosen) return std::vector<JointVector>(waypoints.size(), start);
    return chosen;
  }
};

template <class Selector = First>
std::vector<std::string_view> broken_when(Spoil spoil) {
  const auto model = std::make_shared<const RobotModel>(winder());
  const SelectSubject subject{"spoilt", model,
                              std::make_shared<Selector>(*model, std::move(spoil))};
  std::vector<std::string_view> names;
  for (const Law<SelectSubject>& law : select_laws()) {
    const LawReport report = check_law(law, subject);
    EXPECT_GT(report.questions, 0) << law.name;
    if (!report.kept()) names.push_back(law.name);
  }
  return names;
}

TEST(SelectLawsThemselves, AreKeptByTheFirstBranchWithinLimits) {
  EXPECT_THAT(broken_when([](auto&) {}), IsEmpty());
}

TEST(SelectLawsThemselves, FindAPositionThatIsMissingOrNoBranch) {
  const std::vector<std::pair<std::string_view, Spoil>> spoils{
      {"too few", [](auto& chosen) { chosen.resize(chosen.size() / 2); }},
      {"too short",
       [](auto& chosen) {
         if (!chosen.empty()) chosen.back() = JointVector::Zero(1);
       }},
      {"1 um beside the branch", [](auto& chosen) {
         for (JointVector& q : chosen) q[1] += 1e-6;
       }}};
  for (const auto& [name, spoil] : spoils) {
    EXPECT_THAT(broken_when(spoil),
                ElementsAre("ChoosesABranchOfEveryWaypointWithinLimitsAndNearTheOneBefore",
                            "AnOnlyBranchIsFollowedOverWholeTurns",
                            "AsManyBranchesAsThereMayBeAreConsidered"))
        << name;
  }
}

TEST(SelectLawsThemselves, FindAWholeTurnTooMuch) {
  const auto turned = [](auto& chosen) {
    for (JointVector& q : chosen) q[0] += (q[0] > 0 ? -2 : 2) * std::numbers::pi;
  };
  EXPECT_THAT(broken_when(turned),
              IsSupersetOf({"ChoosesABranchOfEveryWaypointWithinLimitsAndNearTheOneBefore",
                            "AnOnlyBranchIsFollowedOverWholeTurns"}));
}

TEST(SelectLawsThemselves, FindASelectorThatRemembers) {
  int calls = 0;
  const auto remembers = [&calls](auto& chosen) {
    ++calls;
    for (JointVector& q : chosen) q[1] += 1e-13 * calls;
  };
  EXPECT_THAT(broken_when(remembers), ElementsAre("EqualInputGivesEqualBits"));
}

TEST(SelectLawsThemselves, FindASelectorThatRefusesNothing) {
  EXPECT_THAT(broken_when<Credulous>([](auto&) {}),
              ElementsAre("NamesTheWaypointThatHasNoBranchWithinLimits",
                          "RefusesJointPositionsThatAreNone"));
}

}  // namespace
}  // namespace armature
