// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/registration/laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "armature/kinds/registration/explained_fit.hpp"
#include "armature/kinds/registration/moved_head.hpp"
#include "armature/kinds/registration/single_error.hpp"
#include "armature/kinds/registration/target_error.hpp"

namespace armature {
namespace {

constexpr auto kSeed = MovedHead::kSeed;

void asks_round(LawCheck& check, int round) {
  check.asks(fmt::format("six markers on a head, seed {}, round {}", kSeed, round));
}

void finds_the_motion(const RegistrationSubject& subject, LawCheck& check) {
  MovedHead head;
  for (int i = 0; i < 1000; ++i) {
    asks_round(check, i);
    const Eigen::Isometry3d truth = head.random_motion();
    const auto found = subject.registrar->find(head.seen(truth));
    if (!check.answered(found, "markers without error")) return;
    check.that((found->robot_T_image.matrix() - truth.matrix()).cwiseAbs().maxCoeff() < 1e-12,
               "the map is the motion to 1e-12");
    check.that(found->fre_m < 1e-12, "the fiducial registration error is less than 1e-12 m");
    check.that(found->condition >= 1 && std::isfinite(found->condition),
               "the condition is a number of at least 1");
  }
}

void tells_residuals(const RegistrationSubject& subject, LawCheck& check) {
  MovedHead head;
  const MarkerPairs markers = head.with_noise(head.seen_anywhere(), 0.0005);
  const auto found = subject.registrar->find(markers);
  if (!check.answered(found, "markers with an error of 0.5 mm")) return;
  if (!check.equal(found->residual_m.size(), markers.image.size(), "the number of residuals") ||
      !check.equal(found->used.size(), markers.image.size(), "the length of 'used'")) {
    return;
  }
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < markers.image.size(); ++i) {
    const double off = (found->robot_T_image * markers.image[i] - markers.robot[i]).norm();
    check.near(found->residual_m[i], off, 1e-15, fmt::format("residual {} [m]", i + 1));
    if (found->used[i]) sum += off * off, ++count;
  }
  check.that(count >= subject.least, "as many markers are used as it needs");
  check.near(found->fre_m, std::sqrt(sum / static_cast<double>(count)), 1e-15,
             "the rms of the residuals of the markers used [m]");
}

void independent_of_frames(const RegistrationSubject& subject, LawCheck& check) {
  MovedHead head;
  const MarkerPairs markers = head.with_noise(head.seen_anywhere(), 0.0005);
  const auto found = subject.registrar->find(markers);
  if (!check.answered(found, "markers with an error of 0.5 mm")) return;
  for (int i = 0; i < 100; ++i) {
    asks_round(check, i);
    const Eigen::Isometry3d left = head.random_motion(), right = head.random_motion();
    MarkerPairs moved = markers;
    for (Eigen::Vector3d& marker : moved.robot) marker = left * marker;
    for (Eigen::Vector3d& marker : moved.image) marker = right * marker;
    const auto again = subject.registrar->find(moved);
    if (!check.answered(again, "the same markers in other frames")) return;
    const Eigen::Affine3d expected = left * found->robot_T_image * right.inverse();
    check.that((again->robot_T_image.matrix() - expected.matrix()).cwiseAbs().maxCoeff() < 1e-11,
               "the map is moved as its frames are, to 1e-11");
    check.near(again->fre_m, found->fre_m, 1e-12, "the fiducial registration error [m]");
  }
}

void target_error_as_predicted(const RegistrationSubject& subject, LawCheck& check) {
  constexpr double kMarkerError = 0.0005;  // [m]
  constexpr int kTrials = 20000;           // the rms is known to 0.4 %, the quantile to 0.7 %
  const Registrar& registrar = *subject.registrar;
  MovedHead head;
  for (const Eigen::Vector3d& target :
       {Eigen::Vector3d{0.012, -0.008, 0.015}, Eigen::Vector3d{0, 0, -0.06}}) {
    check.asks(fmt::format("a target at ({}, {}, {}) m of the image, 20000 registrations, seed {}",
                           target.x(), target.y(), target.z(), kSeed));
    const MarkerPairs exact = head.seen_anywhere();
    const auto truth = registrar.find(exact);
    const auto predicted = predicted_error(registrar, exact, target, kMarkerError);
    if (!check.answered(truth, "markers without error") ||
        !check.answered(predicted, "a prediction of the error at a target")) {
      return;
    }
    double sum = 0;
    int beyond = 0;
    for (int i = 0; i < kTrials; ++i) {
      const auto found = registrar.find(head.with_noise(exact, kMarkerError));
      if (!check.answered(found, "markers with an error of 0.5 mm")) return;
      const double off = (found->robot_T_image * target - truth->robot_T_image * target).norm();
      sum += off * off;
      if (off > predicted->bound95_m) ++beyond;
    }
    check.near(std::sqrt(sum / kTrials) / predicted->rms_m, 1, 0.02,
               "the error at the target, rms, as a part of what was predicted");
    check.near(static_cast<double>(beyond) / kTrials, 0.05, 0.006,
               "the part of the errors beyond the bound of 95 of 100");
  }
}

/// Markers anywhere on the upper half of a head, of which one is 1 to 30 mm beside its place.
MarkerPairs with_one_wrong(MovedHead& head, std::size_t count, std::size_t wrong,
                           const Eigen::Isometry3d& robot_T_image, double marker_error_m) {
  MarkerPairs markers;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d way = head.gauss(1).normalized();
    markers.image.push_back(0.09 * Eigen::Vector3d{way.x(), way.y(), std::abs(way.z())});
    markers.robot.push_back(robot_T_image * markers.image.back());
  }
  markers = head.with_noise(std::move(markers), marker_error_m);
  markers.robot[wrong] += head.uniform(0.001, 0.03) * head.gauss(1).normalized();
  return markers;
}

void one_wrong(const RegistrationSubject& subject, LawCheck& check) {
  constexpr double kMarkerError = 0.0005;  // [m]
  constexpr int kTrials = 2000;
  const Eigen::Vector3d target{0.010, 0.005, 0.012};
  MovedHead head;
  for (std::size_t count = 4; count <= 12; ++count) {
    check.asks(fmt::format("{} markers anywhere on a head, one 1 to 30 mm off, 2000 times, seed {}",
                           count, kSeed));
    int beyond = 0;
    double most = 0;
    for (int i = 0; i < kTrials; ++i) {
      const Eigen::Isometry3d truth = head.random_motion();
      const MarkerPairs markers =
          with_one_wrong(head, count, static_cast<std::size_t>(i) % count, truth, kMarkerError);
      const auto found = subject.registrar->find(markers);
      if (!found || unexplained_fit(markers, *found, kMarkerError)) continue;
      const auto error = error_with_one_wrong(markers, *found, target, kMarkerError);
      if (!error) continue;
      const double off = (found->robot_T_image * target - truth * target).norm();
      if (off > error->bound95_m) ++beyond;
      most = std::max(most, off / error->bound95_m);
    }
    check.at_most(beyond, 0.01 * kTrials, "the number of those whose error is beyond the bound");
    check.at_most(most, 2, "the largest error as a part of the bound");
  }
}

void same_bits(const RegistrationSubject& subject, LawCheck& check) {
  MovedHead head;
  const MarkerPairs markers = head.with_noise(head.seen_anywhere(), 0.0005);
  const auto first = subject.registrar->find(markers);
  static_cast<void>(subject.registrar->find(head.seen_anywhere()));
  const auto second = subject.registrar->find(markers);
  if (!check.answered(first, "markers with an error of 0.5 mm") ||
      !check.answered(second, "the same markers again")) {
    return;
  }
  check.that(first->robot_T_image.matrix() == second->robot_T_image.matrix(),
             "equal markers give the same map to the bit");
  check.equal(first->fre_m, second->fre_m, "the fiducial registration error [m]");
}

void refuses_useless(const RegistrationSubject& subject, LawCheck& check) {
  const MarkerPairs good = MovedHead{}.seen_anywhere();
  const auto answer = [&](const std::string& question, auto change) {
    MarkerPairs bad = good;
    change(bad);
    check.asks(question);
    const auto found = subject.registrar->find(bad);
    check.answered(subject.registrar->find(good), "good markers after bad ones");
    return found;
  };
  const std::size_t too_few = subject.least - 1;
  check.refused_with(answer("a marker too few",
                            [&](auto& m) { m.image.resize(too_few), m.robot.resize(too_few); }),
                     fmt::format("{} markers, at least {} are needed", too_few, subject.least));
  check.refused_with(
      answer("a marker that the robot has not seen", [](auto& m) { m.robot.pop_back(); }),
      "6 markers in the image, 5 before the robot");
  check.refused_with(answer("NaN in the image", [](auto& m) { m.image[1].y() = NAN; }),
                     "marker 2 of the image is not finite");
  check.refused_with(
      answer("infinity before the robot", [](auto& m) { m.robot[2].x() = INFINITY; }),
      "marker 3 of the robot is not finite");
  const auto lie_nearly = [&](const Expected<Registration>& found) {
    check.that(!found && found.error().text.find("lie nearly ") != std::string::npos,
               "the refusal says that the markers lie nearly on one line, or in one place");
  };
  lie_nearly(answer("markers on a line", [](auto& m) {
    for (std::size_t i = 0; i < m.image.size(); ++i) {
      m.image[i] = m.robot[i] = Eigen::Vector3d{0.02, 0.03, -0.01} * static_cast<double>(i);
    }
  }));
  lie_nearly(answer("markers in one place", [](auto& m) {
    for (std::size_t i = 0; i < m.image.size(); ++i) m.image[i] = m.robot[i] = {0.1, 0.2, 0.3};
  }));
}

}  // namespace

#define ARMATURE_LAW_ENTRY(Name, function, says) Law<RegistrationSubject>{#Name, says, &function},
std::span<const Law<RegistrationSubject>> registration_laws() {
  static constexpr std::array kLaws{ARMATURE_REGISTRATION_LAWS(ARMATURE_LAW_ENTRY)};
  return kLaws;
}

}  // namespace armature
