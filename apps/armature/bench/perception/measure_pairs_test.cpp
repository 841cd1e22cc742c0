// SPDX-License-Identifier: Apache-2.0
// Pairs are measured against what was drawn: 1. a sound estimator is right, 2. one that is wrong
// and says that it is valid is counted as that, 3. a refusal and what a plugin throws are told, 4.
// what is remembered is kept in sequences only, 5. the finder's own share is told apart.
#include "bench/perception/measure_pairs.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <stdexcept>

#include "bench/perception/finder_bias.hpp"
#include "bench/perception/simple_finder_test.hpp"
#include "bench/perception/worst_pairs.hpp"

namespace armature::bench {
namespace {

/// Triangulates eyes and mouth; the mouth `off_m` farther away.
class Triangulating : public FacePoseEstimator {
 public:
  explicit Triangulating(double off_m = 0) : off_m_{off_m} {}
  Expected<FacePose> estimate(const FacePoseInput& input, PluginState& state) override {
    const Count* before = state.get<Count>();
    remembered.push_back(before ? before->calls : 0);
    state.set(Count{remembered.back() + 1});
    const auto at = [&](FaceFeature feature) {
      return input.camera.triangulate(input.landmarks.left.feature(feature).point,
                                      input.landmarks.right.feature(feature).point);
    };
    FacePose pose;
    pose.left_eye = at(FaceFeature::left_eye);
    pose.right_eye = at(FaceFeature::right_eye);
    pose.mouth = at(FaceFeature::mouth) + Eigen::Vector3d{0, 0, off_m_};
    pose.normal = scene::FacePoints{pose.left_eye, pose.right_eye, pose.mouth}.normal();
    return pose;
  }
  std::vector<int> remembered;  // how many calls before, of each call

 private:
  struct Count {
    static constexpr auto kLayout = layout_id("face_pose/triangulating", 1);
    int calls;
  };
  double off_m_;
};

class Refusing : public FacePoseEstimator {
 public:
  Expected<FacePose> estimate(const FacePoseInput&, PluginState&) override {
    return refuse("not sure enough");
  }
};
class Throwing : public FacePoseEstimator {
 public:
  Expected<FacePose> estimate(const FacePoseInput&, PluginState&) override {
    throw std::runtime_error("out of luck");
  }
};
class NotANumber : public FacePoseEstimator {
 public:
  Expected<FacePose> estimate(const FacePoseInput&, PluginState&) override {
    FacePose pose;
    pose.mouth.setConstant(std::numeric_limits<double>::quiet_NaN());
    return pose;
  }
};

std::vector<PerceptionCase> some_cases() {
  return {frontal_case(0.03, 0.02, 0.6), frontal_case(0.02, 0.01, 0.55),
          frontal_case(0.035, 0.02, 0.65)};
}

std::vector<PairResult> measured(FacePoseEstimator& estimator, double mouth_low_mm = 0,
                                 const std::vector<PerceptionCase>& cases = some_cases()) {
  EdgeDetector detector;
  BoxFinder finder{mouth_low_mm};
  return measure_pairs(cases, {detector, finder, estimator, nullptr, {.stretch_below = 0}},
                       [](std::size_t) {});
}

TEST(MeasuredPairs, OfASoundEstimatorAreRight) {
  Triangulating sound;
  for (const PairResult& result : measured(sound)) {
    EXPECT_TRUE(result.detected);
    EXPECT_EQ(result.reason, "");
    // The edges are known to half a pixel, which is 0.33 mm across and 4 mm in depth here; the
    // box of the photo averages that.
    EXPECT_FALSE(result.is_wrong()) << result.drawn.mouth_m << " m, " << result.drawn.normal_rad;
    ASSERT_TRUE(result.times.full_pass && result.times.estimator);
    EXPECT_GE(result.times.detector, *result.times.full_pass);
  }
}

TEST(MeasuredPairs, OfAnEstimatorThatIsOffAndCallsItValidAreWrongButValid) {
  Triangulating off{0.02};
  for (const PairResult& result : measured(off)) {
    ASSERT_TRUE(result.pose);
    EXPECT_TRUE(result.is_wrong());
    EXPECT_NEAR(result.drawn.mouth_m, 0.02, 0.005);
    EXPECT_NEAR(result.drawn.normal_rad, std::atan(20.0 / 65), 0.03);
  }
  NotANumber nonsense;
  for (const PairResult& result : measured(nonsense)) EXPECT_TRUE(result.is_wrong());
}

TEST(MeasuredPairs, TellWhyThereIsNoPoseAndAreNotWrong) {
  Refusing refusing;
  Throwing throwing;
  for (const PairResult& result : measured(refusing)) {
    EXPECT_TRUE(result.detected);
    EXPECT_FALSE(result.pose);
    EXPECT_FALSE(result.is_wrong());
    EXPECT_EQ(result.reason, "not sure enough");
  }
  EXPECT_EQ(measured(throwing).front().reason, "the plugin threw: out of luck");
  Triangulating sound;
  const auto unseen = measured(sound, 0, {frontal_case(0, 0, -1)}).front();
  EXPECT_FALSE(unseen.detected);
  EXPECT_EQ(unseen.reason, "no face in the left image");
  EXPECT_FALSE(unseen.times.estimator);
}

TEST(MeasuredPairs, KeepWhatIsRememberedInASequenceOnly) {
  auto cases = some_cases();
  cases.push_back(cases[0]);
  cases[1].continues = cases[2].continues = true;
  Triangulating sound;
  const auto results = measured(sound, 0, cases);
  EXPECT_EQ(sound.remembered, (std::vector<int>{0, 1, 2, 0}));
  EXPECT_TRUE(results[0].times.full_pass && results[3].times.full_pass);
  EXPECT_FALSE(results[1].times.full_pass || results[2].times.full_pass);
}

TEST(MeasuredPairs, ThatTheCamerasGiveAgainAreRefusedAsTheHostRefusesThem) {
  std::vector<PerceptionCase> cases(6, frontal_case(0.03, 0.02, 0.6));
  for (std::size_t i = 0; i < cases.size(); ++i) {
    cases[i].continues = i > 0;
    cases[i].imaging.noise = 0.5;
    cases[i].noise_seed = i == 4 ? 3 : i;
  }
  Triangulating sound;
  const auto results = measured(sound, 0, cases);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(results[i].reason.starts_with("both cameras are frozen"), i == 4) << i;
    EXPECT_EQ(results[i].pose.has_value(), i != 4) << i;
  }
}

TEST(MeasuredPairs, TellTheFindersShareApart) {
  Triangulating sound;
  for (const PairResult& result : measured(sound, 4)) {
    EXPECT_NEAR(result.drawn.mouth_m, 0.004, 0.0025);
    ASSERT_TRUE(result.stereo_only);
    EXPECT_LT(result.stereo_only->mouth_m, result.drawn.mouth_m);
  }
}

TEST(FinderBias, IsWhereTheFinderTakesThePointsToBe) {
  EdgeDetector detector;
  BoxFinder finder{4};
  FinderBias bias{detector, finder};
  Stage stage;
  PerceptionCase turned = frontal_case(0.03, 0.02, 0.6);
  turned.left_T_face.rotate(Eigen::AngleAxisd{0.4, Eigen::Vector3d::UnitY()});
  const auto points = bias.points(turned, stage);
  ASSERT_TRUE(points);
  // Edges are known to half a pixel of 0.55 mm in each of sixteen pictures.
  EXPECT_LT((points->mouth - turned.left_T_face * Eigen::Vector3d{0, 0.004, 0}).norm(), 4e-4);
  EXPECT_LT((points->left_eye - turned.left_T_face * Eigen::Vector3d{-0.0315, -0.065, 0}).norm(),
            4e-4);
  const int asked = detector.asked;
  EXPECT_TRUE(bias.points(frontal_case(0, 0, 0.5), stage));
  EXPECT_EQ(detector.asked, asked) << "a face is measured once";
}

TEST(WorstPairs, AreThoseFarthestOffWhateverIsOff) {
  const auto result = [](double mouth_mm, double normal_deg, bool valid = true) {
    PairResult one;
    if (valid) one.pose = FacePose{};
    one.drawn = {mouth_mm * 1e-3, normal_deg * std::numbers::pi / 180};
    return one;
  };
  const std::vector<PairResult> results{result(1, 1),
                                        result(4, 0.1),
                                        result(90, 90, false),
                                        result(0.1, 20),
                                        result(std::numeric_limits<double>::quiet_NaN(), 0),
                                        result(11, 1)};
  EXPECT_EQ(worst_of(results, 4), (std::vector<std::size_t>{4, 3, 5, 1}));
  EXPECT_EQ(worst_of(results, 99).size(), 5U);
}

}  // namespace
}  // namespace armature::bench
