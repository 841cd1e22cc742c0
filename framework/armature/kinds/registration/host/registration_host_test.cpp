// SPDX-License-Identifier: Apache-2.0
// The host of the registrations: 1. one answer for each request, under its header and id, 2.
// markers in any order are matched first, 3. targets come back with their error, which grows with
// how the markers fit and with what a wrong one would do, 4. bad requests are answered with their
// reason.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "armature/kinds/registration/registration.hpp"
#include "armature/kinds/request_host_test.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/testing/test_plugins.hpp"

namespace armature::registration_host {
namespace {

/// Moves the first marker onto the first.
class FirstMarker final : public Registrar {
 public:
  static inline bool throws = false, uses_all = false;
  static inline void (*spoils)(Registration& found) = nullptr;
  static inline std::size_t asked_with = 0;  // markers, the last time

  Expected<Registration> find(const MarkerPairs& markers) const override {
    if (throws) throw std::runtime_error{"the matrix is singular"};
    if (auto wrong = invalid_input(markers, 1)) return refuse(std::move(*wrong));
    asked_with = markers.image.size();
    Registration found;
    found.robot_T_image.translation() = markers.robot[0] - markers.image[0];
    found.used.assign(markers.image.size(), uses_all);
    found.used[0] = true;
    found.condition = 2.5;
    measure_residuals(markers, found);
    if (spoils) spoils(found);
    return found;
  }
};

PluginRegistry& plugins() {
  return built_plugins_with<FirstMarker>(
      "{armature_plugin: 1, id: registration/first_marker, kind: registration}");
}

const std::array<Eigen::Vector3d, 4> kMarkers{
    {{0, 0, 0}, {0.1, 0, 0}, {0, 0.07, 0}, {0.01, 0.02, 0.05}}};
const Eigen::Vector3d kShift{1, 2, 3};

void add(std::vector<msg::Point>& points, const Eigen::Vector3d& point) {
  assign(points.emplace_back(), point);
}

/// The markers moved by kShift, in reverse order, after a point that is none.
msg::RegistrationRequest request(std::uint64_t id) {
  msg::RegistrationRequest message;
  write_header(message.header_(), Time{static_cast<std::int64_t>(id) * 1000}, kBaseFrame);
  message.request_id_(id);
  for (const Eigen::Vector3d& marker : kMarkers) add(message.image_markers_(), marker);
  add(message.robot_markers_(), {9, 9, 9});
  for (std::size_t i = kMarkers.size(); i-- > 0;) {
    add(message.robot_markers_(), kMarkers[i] + kShift);
  }
  message.match_tolerance_(0.003);
  message.marker_error_(0.0005);
  add(message.targets_(), {0.03, 0.02, 0.01});
  return message;
}

class RegistrationHostTest
    : public RequestHostTest<msg::RegistrationRequest, msg::RegistrationResponse> {
 protected:
  RegistrationHostTest()
      : RequestHostTest{plugins(),
                        {.component = "{plugin: registration/first_marker}", .robot = {}}} {}

  /// The answer of a host that is told that the images are not mirrored.
  static msg::RegistrationResponse ask_vouched(const msg::RegistrationRequest& question) {
    ComponentHarness vouched{
        plugins(),
        {.component = "{plugin: registration/first_marker, params: {handedness_vouched: true}}",
         .robot = {}}};
    vouched.send("request", question);
    vouched.step(0.1);
    return vouched.take<msg::RegistrationResponse>("response").at(0);
  }
};

TEST_F(RegistrationHostTest, TellsTheMapItsMarkersAndTheTargets) {
  const msg::RegistrationResponse answer = ask(request(7));
  EXPECT_TRUE(answer.valid_()) << answer.reason_();
  EXPECT_EQ(answer.request_id_(), 7u);
  EXPECT_EQ(answer.header_(), request(7).header_());
  EXPECT_EQ(answer.robot_marker_(), (std::vector<std::uint32_t>{4, 3, 2, 1}));
  EXPECT_EQ(answer.used_(), (std::vector<bool>{true, false, false, false}));
  const std::array<double, 12> map{1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3};
  for (std::size_t i = 0; i < map.size(); ++i) {
    EXPECT_NEAR(answer.robot_t_image_()[i], map[i], 1e-15) << i;
  }
  for (const double residual : answer.residuals_()) EXPECT_LT(residual, 1e-12);
  EXPECT_EQ(answer.residuals_().size(), 4u);
  EXPECT_LT(answer.fre_(), 1e-12);
  EXPECT_EQ(answer.condition_(), 2.5);
  ASSERT_EQ(answer.targets_().size(), 1u);
  const Eigen::Vector3d target = to_eigen(answer.targets_()[0].position_());
  EXPECT_LT((target - Eigen::Vector3d{1.03, 2.02, 3.01}).norm(), 1e-12);
  EXPECT_NEAR(answer.targets_()[0].error_rms_(), 0.0005, 1e-9);
  EXPECT_GT(answer.targets_()[0].error_95_(), 0.0005);
}

TEST_F(RegistrationHostTest, PredictsErrorsWithTheUsedMarkersOnly) {
  EXPECT_TRUE(ask(request(5)).valid_());
  EXPECT_EQ(FirstMarker::asked_with, 1u);
  msg::RegistrationRequest without_targets = request(5);
  without_targets.targets_().clear();
  EXPECT_TRUE(ask(without_targets).valid_());
  EXPECT_EQ(FirstMarker::asked_with, kMarkers.size());
}

TEST_F(RegistrationHostTest, TakesOrderedMarkersAsTheyStand) {
  msg::RegistrationRequest ordered = request(1);
  ordered.ordered_(true);
  EXPECT_EQ(ask(ordered).reason_(), "4 markers in the image, 5 before the robot");
  ordered.robot_markers_().pop_back();
  ordered.targets_().clear();  // nothing is predicted of markers that disagree
  const msg::RegistrationResponse answer = ask(ordered);
  EXPECT_EQ(answer.robot_marker_(), (std::vector<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(answer.robot_t_image_()[3], 9) << "the first point, marker or not";
}

TEST_F(RegistrationHostTest, AnswersABadRequestWithItsReasonAndTheNextOneAsIfNothingHadBeen) {
  const auto refusal = [&](auto change) {
    msg::RegistrationRequest bad = request(5);
    change(bad);
    return refusal_of(bad, request(6));
  };
  EXPECT_EQ(refusal([](auto& r) { r.image_markers_()[1].x_(NAN); }),
            "planned marker 2 is not finite");
  EXPECT_EQ(refusal([](auto& r) { r.robot_markers_().resize(3); }),
            "4 markers are planned, 3 points measured");
  EXPECT_EQ(refusal([](auto& r) { r.match_tolerance_(0); }), "the tolerance is 0 m");
  EXPECT_EQ(refusal([](auto& r) { r.marker_error_(NAN); }), "a marker's error is nan m");
  EXPECT_EQ(refusal([](auto& r) { r.marker_error_(-1); }), "a marker's error is -1 m");
  EXPECT_EQ(refusal([](auto& r) { r.targets_()[0].z_(INFINITY); }), "the target is not finite");
}

TEST_F(RegistrationHostTest, RefusesMorePointsThanItMapsInTimeWithTheirNumber) {
  const auto refusal = [&](auto change) {
    msg::RegistrationRequest large = request(5);
    change(large);
    return ask(large).reason_();
  };
  EXPECT_EQ(refusal([](auto& r) { r.image_markers_().resize(200); }),
            "200 markers in the image, 64 at most are taken");
  EXPECT_EQ(refusal([](auto& r) { r.robot_markers_().resize(65); }),
            "65 markers before the robot, 64 at most are taken");
  EXPECT_EQ(refusal([](auto& r) { r.targets_().resize(100000); }),
            "100000 targets, 64 at most are taken");
}

TEST_F(RegistrationHostTest, DoesNotPredictFromAnErrorThatDoesNotExplainTheFit) {
  msg::RegistrationRequest stretched = request(5);
  for (auto& marker : stretched.robot_markers_()) marker.x_(marker.x_() * 1.02);
  stretched.marker_error_(0.0003);
  FirstMarker::uses_all = true;
  const std::string refused = ask(stretched).reason_();
  stretched.marker_error_(0.002);
  const bool explained = ask(stretched).valid_();
  stretched.marker_error_(0.0001);
  stretched.targets_().clear();
  const bool without_targets = ask(stretched).valid_();
  FirstMarker::uses_all = false;
  EXPECT_NE(refused.find("which an error of 0.3 mm a marker does not explain (at most"),
            std::string::npos)
      << refused;
  EXPECT_TRUE(explained);
  EXPECT_TRUE(without_targets) << "nothing is predicted from it";
}

TEST_F(RegistrationHostTest, PredictsFromTheErrorThatTheMarkersShowWhereTheyFitWorseThanIsStated) {
  msg::RegistrationRequest stretched = request(5);
  for (auto& marker : stretched.robot_markers_()) marker.x_(marker.x_() * 1.02);
  stretched.marker_error_(0.0005);
  FirstMarker::uses_all = true;
  const msg::RegistrationResponse answer = ask(stretched);
  FirstMarker::uses_all = false;
  ASSERT_TRUE(answer.valid_()) << answer.reason_();
  EXPECT_GT(answer.targets_()[0].error_rms_(), 0.0006);
  EXPECT_GT(answer.targets_()[0].error_95_(), answer.targets_()[0].error_rms_());
}

TEST_F(RegistrationHostTest, CountsInTheBoundWhatAWrongMarkerDoes) {
  const double right = ask(request(5)).targets_()[0].error_95_();
  msg::RegistrationRequest wrong = request(5);
  wrong.robot_markers_().back().z_(wrong.robot_markers_().back().z_() + 0.002);  // of marker 1
  const msg::RegistrationResponse answer = ask(wrong);
  ASSERT_TRUE(answer.valid_()) << answer.reason_();
  EXPECT_GT(answer.targets_()[0].error_95_(), 0.002);
  EXPECT_LT(right, 0.0015);
}

/// Three markers in both frames, of which one mirrors the other.
msg::RegistrationRequest mirrored_triangle() {
  msg::RegistrationRequest three = request(5);
  three.image_markers_().pop_back();
  three.robot_markers_().clear();
  for (const msg::Point& marker : three.image_markers_()) {
    add(three.robot_markers_(), {-marker.x_(), marker.y_(), marker.z_()});
  }
  return three;
}

TEST_F(RegistrationHostTest, RefusesMarkersThatDoNotTellAMirroredImageUnlessSomebodyVouchesForIt) {
  const msg::RegistrationResponse answer = ask(mirrored_triangle());
  EXPECT_FALSE(answer.valid_());
  EXPECT_NE(answer.reason_().find("the markers do not tell whether the images are mirrored"),
            std::string::npos)
      << answer.reason_();
  EXPECT_TRUE(ask_vouched(mirrored_triangle()).valid_());
}

TEST_F(RegistrationHostTest, NamesAMarkerThatNothingChecks) {
  msg::RegistrationRequest line = request(5);
  line.image_markers_()[3] = line.image_markers_()[0];
  line.image_markers_()[3].x_(0.05);  // between the first two
  line.ordered_(true);
  line.robot_markers_() = line.image_markers_();
  EXPECT_EQ(ask_vouched(line).reason_(),
            "nothing checks marker 3: without it the others lie nearly on one line");
}

TEST_F(RegistrationHostTest, MarkersMayBeToldInAnyFrameAndTheAnswerIsInTheSame) {
  msg::RegistrationRequest on_a_jaw = request(5);
  on_a_jaw.header_().frame_id_() = "jaw";
  const msg::RegistrationResponse answer = ask(on_a_jaw);
  EXPECT_TRUE(answer.valid_()) << answer.reason_();
  EXPECT_EQ(answer.header_().frame_id_(), "jaw");
}

TEST_F(RegistrationHostTest, AnExceptionOfThePluginIsAReasonAndTheNextRequestIsAnswered) {
  expect_survives(FirstMarker::throws, request(1));
}

TEST_F(RegistrationHostTest, AnAnswerOfThePluginThatIsNoneIsRefused) {
  const auto refusal_with = [&](void (*spoils)(Registration&)) {
    FirstMarker::spoils = spoils;
    const msg::RegistrationResponse answer = ask(request(1));
    FirstMarker::spoils = nullptr;
    EXPECT_FALSE(answer.valid_());
    return answer.reason_();
  };
  EXPECT_EQ(refusal_with([](Registration& found) { found.used.resize(5, true); }),
            "the plugin tells 5 markers and 4 residuals of 4 markers");
  EXPECT_EQ(refusal_with([](Registration& found) { found.residual_m.pop_back(); }),
            "the plugin tells 4 markers and 3 residuals of 4 markers");
  EXPECT_EQ(refusal_with([](Registration& found) { found.used.assign(4, false); }),
            "the plugin tells a map, and that it used no marker");
  EXPECT_EQ(refusal_with([](Registration& found) { found.robot_T_image(0, 3) = NAN; }),
            "the plugin's map is not finite");
}

}  // namespace
}  // namespace armature::registration_host
