// SPDX-License-Identifier: Apache-2.0
// The laws of marker finders find those that break them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>
#include <vector>

#include "armature/kinds/markers/laws.hpp"

namespace armature {
namespace {

using testing::Contains, testing::ElementsAre, testing::Not;

/// Finds nothing anywhere.
class Blind : public MarkerFinder {
 public:
  Expected<std::vector<FoundMarker>> find(const Volume& volume) const override {
    if (auto wrong = invalid_input(volume)) return refuse(*wrong);
    return std::vector<FoundMarker>{};
  }
  double marker_radius() const override { return 0.005; }
};

/// Takes every volume for one with a marker in its middle.
class Credulous : public Blind {
 public:
  Expected<std::vector<FoundMarker>> find(const Volume& volume) const override {
    const auto& size = volume.geometry.size;
    const Eigen::Vector3d middle{0.5 * size[0], 0.5 * size[1], 0.5 * size[2]};
    return std::vector{FoundMarker{volume.geometry.point_at(middle), 0.005, 1e-6, 1}};
  }
};

template <class Finder>
std::vector<std::string_view> broken() {
  std::vector<std::string_view> names;
  const MarkerSubject subject{"one", std::make_shared<Finder>()};
  for (const Law<MarkerSubject>& law : marker_laws()) {
    if (!check_law(law, subject).kept()) names.push_back(law.name);
  }
  return names;
}

TEST(MarkerLawsThemselves, FindAFinderThatIsBlind) {
  EXPECT_THAT(broken<Blind>(),
              ElementsAre("FindsEveryCentreToATenthOfAVoxel", "TakesNothingElseForAMarker",
                          "AMarkerThatIsMissingIsMissing"));
}

TEST(MarkerLawsThemselves, FindAFinderThatTakesEverythingForAMarker) {
  const auto names = broken<Credulous>();
  EXPECT_THAT(names, Contains("FindsNoneWhereThereIsNone"));
  EXPECT_THAT(names, Contains("SaysHowFarOffACentreMayBe"));
  EXPECT_THAT(names, Contains("RefusesWhatIsNoVolume"));
  EXPECT_THAT(names, Not(Contains("GivesTheSameBitsForTheSameVolume")));
}

}  // namespace
}  // namespace armature
