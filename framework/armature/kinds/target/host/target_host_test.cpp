// SPDX-License-Identifier: Apache-2.0
// The host of the target filters: 1. a face pose goes through where the arm was when the picture
// was taken, 2. one answer for each face, stamped as its picture, 3. the filter predicts over a
// gap, then what is missing is told, 4. a bad joint state, or a history that does not reach to the
// pictures, is told as the component's own trouble, 5. and so are cameras that have a face
// elsewhere from near than from afar.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <numbers>
#include <random>
#include <stdexcept>

#include "armature/kinds/target/target_messages.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/files/stereo_rig.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/robot/model/test_robots.hpp"
#include "armature/runtime/testing/component_harness.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::host::target {
namespace {

using Eigen::Vector3d;
using testing::joint_vector;

/// The newest measurement; predicts for half a second.
class LastLook final : public TargetFilter {
 public:
  static inline TargetMeasurement asked;
  static inline bool throws = false;

  Expected<TargetEstimate> update(const TargetMeasurement& measurement,
                                  PluginState& state) const override {
    asked = measurement;
    if (!measurement.position.allFinite()) return refuse("the position is not finite");
    const Look* last = state.get<Look>();
    if (last && measurement.stamp <= last->stamp) return refuse("an older picture");
    const Eigen::Vector3d& p = measurement.position;
    Look look{measurement.stamp, {p.x(), p.y(), p.z()}, last ? last->count : 0};
    if (throws) throw std::runtime_error{"the matrix is singular"};
    ++look.count;
    state.set(look);
    return estimate(measurement.stamp, look);
  }
  Expected<TargetEstimate> predict(Time when, const PluginState& state) const override {
    const Look* last = state.get<Look>();
    if (!last || when - last->stamp > seconds(0.5)) return refuse("too long ago");
    return estimate(when, *last);
  }

 private:
  struct Look {
    static constexpr auto kLayout = layout_id("target/last_look", 1);
    Time stamp;
    std::array<double, 3> position;
    int count;
  };
  static TargetEstimate estimate(Time stamp, const Look& look) {
    return {.stamp = stamp,
            .position = Vector3d{look.position.data()},
            .normal = Vector3d::UnitX(),
            .velocity = {0.1, 0.2, 0.3},
            .normal_rate = {0, 0.5, 0},
            .measurements = look.count};
  }
};

PluginRegistry& plugins() {
  return built_plugins_with<LastLook>("{armature_plugin: 1, id: target/last_look, kind: target}");
}

const std::string kRig = ARMATURE_SOURCE_DIR "/configs/rigs/default.yaml";
const RobotModel& lamp() {
  static const RobotModel model = testing::dental_lamp();
  return model;
}

msg::FacePose face(double stamp_s) {
  msg::FacePose message;
  write_header(message.header_(), Time{} + seconds(stamp_s), "left_camera_optical");
  message.valid_(true);
  assign(message.mouth_(), Vector3d{0.06, 0.02, 0.5});
  assign(message.normal_(), Vector3d{0, 0, -1});
  message.mouth_covariance_({1e-6, 0, 0, 0, 2e-6, 0, 0, 0, 9e-6});
  message.normal_covariance_({4e-4, 0, 0, 0, 1e-4, 0, 0, 0, 0});
  return message;
}

msg::JointState arm_at(double stamp_s, const JointVector& q) {
  msg::JointState message;
  write_header(message.header_(), Time{} + seconds(stamp_s), kBaseFrame);
  const JointVector all = lamp().to_all(q);
  message.position_().assign(all.begin(), all.end());
  return message;
}

/// base_T_left with the arm at `q`.
Eigen::Isometry3d camera_at(const JointVector& q) {
  const StereoRig rig = load_stereo_rig(kRig);
  return forward_kinematics(lamp(), q, *lamp().find_frame(rig.mounted_on)) * rig.mount_T_left;
}

class TargetHostTest : public ::testing::Test {
 protected:
  static ComponentHarness bench(const std::string& params = "") {
    return {plugins(),
            {.component = "{plugin: target/last_look, params: {" + params + "}}",
             .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml"),
             .rig = config::load(kRig)}};
  }
  msg::Target see(const msg::FacePose& seen) {
    host_.send("face", seen);
    EXPECT_TRUE(host_.triggered());
    host_.step(10);
    const auto targets = host_.take<msg::Target>("target");
    EXPECT_EQ(targets.size(), 1u);
    return targets.empty() ? msg::Target{} : targets.front();
  }
  const JointVector kHome = lamp().to_independent(*lamp().home()).value();
  const JointVector kAway = kHome + joint_vector({0.2, 0.1, 0.1, -0.2, 0.1});
  ComponentHarness host_{bench()};
};

TEST_F(TargetHostTest, CarriesAFaceThroughWhereTheArmWasWhenThePictureWasTaken) {
  host_.send("measured_js", arm_at(1.0, kHome));
  host_.send("measured_js", arm_at(1.1, kAway));
  EXPECT_FALSE(host_.triggered()) << "the arm alone is no reason to compute";
  const msg::Target target = see(face(1.05));
  const Eigen::Isometry3d base_T_left = camera_at(0.5 * (kHome + kAway));
  EXPECT_LE((LastLook::asked.position - base_T_left * Vector3d{0.06, 0.02, 0.5}).norm(), 1e-12);
  EXPECT_LE((LastLook::asked.normal + base_T_left.linear().col(2)).norm(), 1e-12);
  EXPECT_EQ(LastLook::asked.stamp, Time{} + seconds(1.05));
  // The covariances turn with the camera.
  const Eigen::Matrix3d turn = base_T_left.linear();
  const Vector3d variances{1e-6, 2e-6, 9e-6}, of_normal{4e-4, 1e-4, 0};
  EXPECT_LT((LastLook::asked.position_covariance - turn * variances.asDiagonal() * turn.transpose())
                .norm(),
            1e-15);
  EXPECT_LT(
      (LastLook::asked.normal_covariance - turn * of_normal.asDiagonal() * turn.transpose()).norm(),
      1e-12);
  EXPECT_EQ(stamp_of(target.header_().stamp_()), Time{} + seconds(1.05));
  EXPECT_EQ(target.header_().frame_id_(), "base");
  EXPECT_TRUE(target.valid_());
  EXPECT_EQ(target.reason_(), "");
  EXPECT_EQ(to_eigen(target.position_()), LastLook::asked.position);
  EXPECT_EQ(to_eigen(target.normal_()), Vector3d::UnitX());
  EXPECT_EQ(to_eigen(target.velocity_()), (Vector3d{0.1, 0.2, 0.3}));
  EXPECT_EQ(to_eigen(target.normal_rate_()), (Vector3d{0, 0.5, 0}));
  EXPECT_EQ(target.measurements_(), 1u);
}

TEST_F(TargetHostTest, AnswersEveryFaceOnceInOrder) {
  for (int i = 0; i <= 4; ++i) host_.send("measured_js", arm_at(1 + 0.1 * i, kHome));
  for (int i = 0; i < 4; ++i) host_.send("face", face(1 + 0.1 * i));
  host_.step(2);
  const auto targets = host_.take<msg::Target>("target");
  ASSERT_EQ(targets.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(stamp_of(targets[i].header_().stamp_()),
              Time{} + seconds(1 + 0.1 * static_cast<double>(i)));
    EXPECT_EQ(targets[i].measurements_(), i + 1);
  }
  host_.step(2.1);
  EXPECT_TRUE(host_.take<msg::Target>("target").empty());
}

TEST_F(TargetHostTest, SaysWhenTheHistoryDoesNotReachToThePicture) {
  EXPECT_EQ(see(face(1)).reason_(), "no joint positions have arrived yet");
  host_.send("measured_js", arm_at(1.000, kHome));
  EXPECT_EQ(see(face(1.012)).reason_(), "t = 1.012 s is 12.0 ms newer than the history");
  EXPECT_EQ(see(face(0.5)).reason_(), "t = 0.500 s is 500.0 ms older than the history");
  host_.send("measured_js", arm_at(1.5, kHome));
  EXPECT_EQ(see(face(1.2)).reason_(), "the joint positions next to t = 1.200 s are 0.500 s apart");
  host_.send("measured_js", arm_at(1.1, kHome));
  EXPECT_TRUE(see(face(1.05)).valid_()) << "a stamp that lies ahead does not keep others out";
}

TEST_F(TargetHostTest, RemembersTheArmForAsLongAsItsParametersSay) {
  ComponentHarness host = bench("history_s: 0.5, arm_rate_hz: 10");  // five samples and one
  for (int i = 0; i < 20; ++i) host.send("measured_js", arm_at(0.1 * i, kHome));
  host.send("face", face(1.45));
  host.send("face", face(1.35));
  host.step(2);
  const auto targets = host.take<msg::Target>("target");
  ASSERT_EQ(targets.size(), 2u);
  EXPECT_TRUE(targets[0].valid_());
  EXPECT_NE(to_eigen(targets[0].position_()), Vector3d::Zero());
  EXPECT_TRUE(targets[1].reason_().empty()) << "predicted over the gap";
  EXPECT_EQ(targets[1].measurements_(), 1u);
}

TEST_F(TargetHostTest, PredictsOverAGapAndThenTellsWhatIsMissing) {
  for (int i = 0; i <= 20; ++i) host_.send("measured_js", arm_at(1 + 0.1 * i, kHome));
  ASSERT_TRUE(see(face(1)).valid_());
  msg::FacePose lost = face(1.3);
  lost.valid_(false);
  lost.reason_("no face in the left image");
  const msg::Target predicted = see(lost);
  EXPECT_TRUE(predicted.valid_());
  EXPECT_EQ(stamp_of(predicted.header_().stamp_()), Time{} + seconds(1.3));
  EXPECT_EQ(predicted.measurements_(), 1u);
  write_header(lost.header_(), Time{} + seconds(1.8), "left_camera_optical");
  const msg::Target gone = see(lost);
  EXPECT_FALSE(gone.valid_());
  EXPECT_EQ(gone.reason_(), "no face in the left image");
  EXPECT_EQ(stamp_of(gone.header_().stamp_()), Time{} + seconds(1.8));
  EXPECT_EQ(gone.header_().frame_id_(), "base");
  EXPECT_EQ(to_eigen(gone.position_()), Vector3d::Zero());
  EXPECT_EQ(to_eigen(gone.velocity_()), Vector3d::Zero());
  EXPECT_EQ(gone.measurements_(), 0u);
}

TEST_F(TargetHostTest, TellsTheFiltersOwnRefusal) {
  host_.send("measured_js", arm_at(1, kHome));
  msg::FacePose broken = face(1);
  broken.mouth_().x_(NAN);
  EXPECT_EQ(see(broken).reason_(), "the position is not finite");
}

TEST_F(TargetHostTest, IsDegradedByABadJointStateUntilAGoodOneComes) {
  msg::JointState bad = arm_at(1, kHome);
  bad.position_().pop_back();
  host_.send("measured_js", bad);
  host_.step(1);
  EXPECT_EQ(host_.status().state, StatusReporter::State::degraded);
  EXPECT_EQ(host_.status().reason, "measured_js: 5 joint values; dental_lamp has 6 joints");
  bad.position_().assign(10'000, 0.0);
  host_.send("measured_js", bad);
  host_.step(1.1);
  EXPECT_EQ(host_.status().reason, "measured_js: 10000 joint values; dental_lamp has 6 joints");
  bad = arm_at(1, kHome);
  bad.position_()[0] = NAN;
  host_.send("measured_js", bad);
  host_.step(1.2);
  EXPECT_EQ(host_.status().reason, "measured_js: j1 = nan is not a number");
  EXPECT_EQ(see(face(1)).reason_(), "no joint positions have arrived yet");
  host_.send("measured_js", arm_at(1, kHome));
  host_.step(1.3);
  EXPECT_EQ(host_.status().state, StatusReporter::State::ok);
}

TEST_F(TargetHostTest, IsDegradedWhileItsHistoryDoesNotReachToThePictures) {
  ComponentHarness host = bench("history_s: 2, arm_rate_hz: 1");  // two samples and one
  const auto see_at = [&](double stamp_s) {
    host.send("face", face(stamp_s));
    host.step(stamp_s + 0.2);
    return host.status();
  };
  EXPECT_EQ(see_at(0.3).reason, "no joint positions have arrived yet");
  for (int i = 0; i < 20; ++i) host.send("measured_js", arm_at(0.5 + 0.1 * i, kHome));
  host.step(2.5);
  EXPECT_EQ(host.status().state, StatusReporter::State::ok);
  EXPECT_EQ(see_at(2.0).state, StatusReporter::State::degraded);
  EXPECT_EQ(host.status().reason, "t = 2.000 s is 200.0 ms older than the history");
  EXPECT_EQ(see_at(2.1).reason, "t = 2.000 s is 200.0 ms older than the history")
      << "told once, not for each picture";
  host.send("measured_js", arm_at(2.5, kHome));
  host.step(2.5);
  EXPECT_EQ(host.status().state, StatusReporter::State::degraded)
      << "the arm's part was never the trouble";
  EXPECT_EQ(see_at(2.35).state, StatusReporter::State::ok);
}

class ApproachingTargetHostTest : public TargetHostTest {
 protected:
  /// A mouth that stirs by `stirs_m` (1 sigma) is looked at from afar, then from near, so often;
  /// `seen` is where the cameras have what is at x. In how many views the host was degraded.
  int degraded_in(int approaches, double stirs_m, const std::function<Vector3d(Vector3d)>& seen) {
    ComponentHarness host = bench();
    std::mt19937 random{kSeed};
    std::normal_distribution<double> stir{0, stirs_m};
    const JointVector kNear = kHome + joint_vector({0.2787, -0.0662, 0, -0.2125, 0});
    const Eigen::Isometry3d far = camera_at(kHome), near = camera_at(kNear);
    int degraded = 0;
    for (int view = 0; view < 2 * approaches; ++view) {
      const Vector3d mouth =
          far * Vector3d{0.06, 0.02, 0.67} + Vector3d{stir(random), stir(random), stir(random)};
      const bool is_near = view % 2 == 1;
      const Vector3d at = seen((is_near ? near : far).inverse() * mouth);
      for (int look = 0; look < 3; ++look) {
        const double now = 1 + 3.0 * view + 0.1 * look;
        host.send("measured_js", arm_at(now, is_near ? kNear : kHome));
        msg::FacePose looked = face(now);
        assign(looked.mouth_(), at);
        host.send("face", looked);
        host.step(now);
      }
      degraded += host.status().state == StatusReporter::State::degraded;
      told_ = host.status().reason;
    }
    return degraded;
  }
  std::string told_;  // in the end
  static constexpr unsigned kSeed = 7;
  static constexpr double kDegree = std::numbers::pi / 180;
};

TEST_F(ApproachingTargetHostTest, CamerasThatAreTurnedSidewaysAreToldOfAfterAFewApproaches) {
  const double baseline_m = load_stereo_rig(kRig).camera.baseline_m;
  EXPECT_GT(degraded_in(6, 0.001,
                        [&](Vector3d x) -> Vector3d {
                          return x * (1 + 0.3 * kDegree * x.z() / baseline_m);
                        }),
            0)
      << "seed " << kSeed;
  EXPECT_NE(told_.find("elsewhere from near than from afar"), std::string::npos) << told_;
  EXPECT_NE(told_.find("degrees of yaw between the cameras"), std::string::npos) << told_;
}

TEST_F(ApproachingTargetHostTest, OfCamerasThatAreRightNothingIsToldHoweverPeopleStir) {
  for (const double stirs_m : {1e-4, 0.003, 0.01}) {
    EXPECT_EQ(degraded_in(200, stirs_m, [](Vector3d x) { return x; }), 0)
        << "seed " << kSeed << ", " << stirs_m << " m";
  }
}

TEST_F(TargetHostTest, DoesNotStartWithARigThatHangsOnNoFrameOfTheRobot) {
  const config::Node rig = config::parse_text(
      "{armature_rig: 1, name: lost, resolution: [640, 480], fov_deg: 60, baseline_mm: 100, "
      "mount: {frame: elbow, forward: [1, 0, 0], right: [0, 0, 1]}}",
      "rig.yaml");
  try {
    ComponentHarness host{
        plugins(),
        {.component = "{plugin: target/last_look}",
         .robot = config::load(ARMATURE_SOURCE_DIR "/configs/robots/dental_lamp.yaml"),
         .rig = rig}};
    ADD_FAILURE() << "it was made";
  } catch (const SetupError& error) {
    EXPECT_STREQ(error.what(),
                 "the rig 'lost' is mounted on 'elbow', which is no frame of the robot "
                 "'dental_lamp'; known: tool");
  }
}

TEST_F(TargetHostTest, AnExceptionOfTheFilterIsAReasonAndItStartsColdAgain) {
  for (int i = 0; i <= 20; ++i) host_.send("measured_js", arm_at(1 + 0.1 * i, kHome));
  EXPECT_EQ(see(face(1)).measurements_(), 1u);
  LastLook::throws = true;
  const msg::Target answer = see(face(1.1));
  LastLook::throws = false;
  EXPECT_FALSE(answer.valid_());
  EXPECT_EQ(answer.reason_(), "the plugin threw: the matrix is singular");
  EXPECT_EQ(see(face(1.2)).measurements_(), 1u);
}

}  // namespace
}  // namespace armature::host::target
