// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/markers/laws.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "armature/kinds/markers/marked_phantom.hpp"

namespace armature {
namespace {

using Eigen::Vector3d;

/// The found marker that is nearest to `centre`.
const FoundMarker& nearest(const std::vector<FoundMarker>& found, const Vector3d& centre) {
  return *std::ranges::min_element(
      found, {}, [&](const FoundMarker& marker) { return (marker.centre - centre).norm(); });
}

/// The greatest of the three parts of an error, each in voxels along its axis.
double in_voxels(const Vector3d& error, const VolumeGeometry& geometry) {
  const Vector3d parts = geometry.direction.transpose() * error;
  return parts.cwiseQuotient(geometry.spacing).cwiseAbs().maxCoeff();
}

void asks_about(LawCheck& check, const MarkedPhantom& phantom) {
  const Vector3d mm = 1e3 * phantom.geometry.spacing;
  check.asks(fmt::format("six markers on a head, voxels of {} x {} x {} mm, noise {}, seed {}",
                         mm.x(), mm.y(), mm.z(), phantom.scanner.noise_hu, phantom.scanner.seed));
}

std::vector<MarkedPhantom> phantoms(const MarkerFinder& finder) {
  std::vector<MarkedPhantom> all;
  const std::array<Vector3d, 5> spacings{
      Vector3d{0.0005, 0.0005, 0.0005}, Vector3d{0.0008, 0.0008, 0.0008},
      Vector3d{0.001, 0.001, 0.001}, Vector3d{0.0007, 0.0007, 0.002},
      Vector3d{0.001, 0.0006, 0.0015}};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Vector3d spacing = spacings[seed % spacings.size()];
    const double noise = seed % 2 == 0 ? 0 : 20;
    all.push_back(marked_phantom(finder.marker_radius(), spacing, noise, seed));
  }
  return all;
}

void finds_every_centre(const MarkerSubject& subject, LawCheck& check) {
  for (const MarkedPhantom& phantom : phantoms(*subject.finder)) {
    asks_about(check, phantom);
    const auto found = subject.finder->find(phantom.scan());
    if (!check.answered(found, "a head with six markers")) return;
    if (!check.equal(found->size(), phantom.markers.size(), "the number of markers")) return;
    for (const Vector3d& marker : phantom.markers) {
      check.at_most(in_voxels(nearest(*found, marker).centre - marker, phantom.geometry), 0.1,
                    "the error of a marker's centre, in voxels along the worst axis");
    }
  }
}

void says_how_far_off(const MarkerSubject& subject, LawCheck& check) {
  for (const MarkedPhantom& phantom : phantoms(*subject.finder)) {
    asks_about(check, phantom);
    const auto found = subject.finder->find(phantom.scan());
    if (!check.answered(found, "a head with six markers") || found->empty()) continue;
    for (const Vector3d& marker : phantom.markers) {
      const FoundMarker& one = nearest(*found, marker);
      check.that(one.confidence > 0 && one.confidence <= 1, "a confidence is above 0, at most 1");
      check.at_most((one.centre - marker).norm(), 4 * one.sigma,
                    "the error of a centre, of which four sigma are the bound [m]");
      check.at_most(one.sigma, 0.2 * phantom.geometry.spacing.maxCoeff(), "a sigma [m]");
      check.near(one.radius / subject.finder->marker_radius(), 1, 0.1, "a radius, in true ones");
    }
  }
}

void finds_none(const MarkerSubject& subject, LawCheck& check) {
  for (const double noise : {0.0, 30.0}) {
    MarkedPhantom phantom =
        marked_phantom(subject.finder->marker_radius(), Vector3d::Constant(0.001), noise, 3);
    phantom.solids.resize(phantom.solids.size() - phantom.markers.size());
    check.asks(fmt::format("a head without markers, noise {}", noise));
    const auto found = subject.finder->find(phantom.scan());
    if (check.answered(found, "a head without markers")) {
      check.equal(found->size(), 0u, "the number of markers where there is none");
    }
  }
}

void takes_nothing_else(const MarkerSubject& subject, LawCheck& check) {
  const double r = subject.finder->marker_radius();
  const Vector3d at{0, 0, 0.087};
  const double dense = kMarkerHu;
  const std::array<std::pair<const char*, Solid>, 4> others{
      std::pair{"a ball of twice the radius", ball(at, 2 * r, dense)},
      {"a ball of half the radius", ball(at, r / 2, dense)},
      {"a needle", Solid{Capsule{{-0.03, 0, 0.087}, {0.03, 0, 0.087}, 0.4 * r}, dense}},
      {"a plate", Solid{Ellipsoid{at, {3 * r, 3 * r, 0.3 * r}}, dense}}};
  for (const auto& [name, solid] : others) {
    MarkedPhantom phantom = marked_phantom(r, Vector3d::Constant(0.001), 10, 3);
    phantom.solids.push_back(solid);
    check.asks(std::string{"six markers and "} + name);
    const auto found = subject.finder->find(phantom.scan());
    if (!check.answered(found, "a head with markers and something else")) continue;
    check.equal(found->size(), phantom.markers.size(), "the number of markers");
  }
}

void misses_the_missing(const MarkerSubject& subject, LawCheck& check) {
  MarkedPhantom phantom =
      marked_phantom(subject.finder->marker_radius(), Vector3d::Constant(0.001), 10, 3);
  const Vector3d gone = phantom.markers.back();
  phantom.solids.pop_back();
  check.asks("a head with five of six markers");
  const auto found = subject.finder->find(phantom.scan());
  if (!check.answered(found, "a head with five markers")) return;
  if (!check.equal(found->size(), phantom.markers.size() - 1, "the number of markers")) return;
  check.that((nearest(*found, gone).centre - gone).norm() > 0.01, "none is where it was");
}

void follows_the_frame(const MarkerSubject& subject, LawCheck& check) {
  const MarkedPhantom phantom =
      marked_phantom(subject.finder->marker_radius(), Vector3d{0.001, 0.001, 0.0015}, 10, 5);
  const Volume volume = phantom.scan();
  const auto first = subject.finder->find(volume);
  if (!check.answered(first, "a head with six markers")) return;
  Eigen::Matrix3d turn{Eigen::AngleAxisd{0.7, Vector3d{1, -2, 0.5}.normalized()}};
  for (const bool mirrored : {false, true}) {
    check.asks(mirrored ? "the same in a left-handed frame" : "the same in a turned frame");
    if (mirrored) turn.row(0) *= -1;
    Volume moved = volume;
    moved.geometry.direction = turn * volume.geometry.direction;
    moved.geometry.origin = turn * volume.geometry.origin + Vector3d{0.1, 0.2, -0.3};
    const auto again = subject.finder->find(moved);
    if (!check.answered(again, "the same in another frame")) return;
    if (!check.equal(again->size(), first->size(), "the number of markers")) return;
    for (const FoundMarker& marker : *first) {
      const Vector3d expected = turn * marker.centre + Vector3d{0.1, 0.2, -0.3};
      check.at_most((nearest(*again, expected).centre - expected).norm(), 1e-5,
                    "how far a marker is from where its frame was moved to [m]");
    }
  }
}

void repeats_bits(const MarkerSubject& subject, LawCheck& check) {
  const double r = subject.finder->marker_radius();
  const Volume one = marked_phantom(r, Vector3d::Constant(0.001), 20, 7).scan();
  const Volume other = marked_phantom(r, Vector3d::Constant(0.001), 20, 8).scan();
  check.asks("the volume of seed 7, of seed 8, of seed 7 again");
  const auto first = subject.finder->find(one);
  static_cast<void>(subject.finder->find(other));
  const auto second = subject.finder->find(one);
  if (!check.answered(first, "a volume") || !check.answered(second, "the same volume")) return;
  if (!check.equal(second->size(), first->size(), "the number of markers")) return;
  for (std::size_t i = 0; i < first->size(); ++i) {
    check.that((*first)[i].centre == (*second)[i].centre, "a centre is the same to the bit");
    check.equal((*second)[i].confidence, (*first)[i].confidence, "the confidence");
  }
}

void refuses_no_volume(const MarkerSubject& subject, LawCheck& check) {
  const Volume sound = scanned({}, {.size = {4, 4, 4}}, {});
  check.asks("no voxels");
  check.refused_with(subject.finder->find({}), "a volume without voxels");
  Volume volume = sound;
  volume.voxels.pop_back();
  check.asks("a voxel less than there should be");
  check.refused_with(subject.finder->find(volume), "a volume of 4 x 4 x 4 voxels with 63 values");
  volume = sound;
  volume.geometry.origin.x() = NAN;
  check.asks("a place that is NaN");
  check.refused_with(subject.finder->find(volume), "a volume whose spacing or place is no length");
  check.asks("air, after what is no volume");
  check.answered(subject.finder->find(sound), "a volume of air");
}

}  // namespace

#define ARMATURE_LAW_ENTRY(Name, function, says) Law<MarkerSubject>{#Name, says, &function},
std::span<const Law<MarkerSubject>> marker_laws() {
  static constexpr std::array kLaws{ARMATURE_MARKER_LAWS(ARMATURE_LAW_ENTRY)};
  return kLaws;
}

}  // namespace armature
