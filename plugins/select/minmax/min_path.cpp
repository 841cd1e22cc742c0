// SPDX-License-Identifier: Apache-2.0
#include "min_path.hpp"

#include <algorithm>

namespace armature::select::minmax {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The same branch at the same turns.
Place* find(std::vector<Place>& places, const IkBranch* branch, const JointVector& q) {
  const auto found = std::ranges::find_if(
      places, [&](const Place& place) { return place.at.branch == branch && place.at.q == q; });
  return found == places.end() ? nullptr : &*found;
}

}  // namespace

double Layers::least() const {
  return std::ranges::min_element(of.back(), {}, &Place::so_far)->so_far;
}

double LeastPath::joined(double so_far, double size, bool counts) const {
  if (measure_ == Measure::sum) return so_far + size;
  return counts ? std::max(so_far, size) : so_far;
}

/// For every branch of every waypoint the least that the moves behind it can come to.
LeastPath::Bounds LeastPath::bounds() const {
  Bounds ahead(waypoints_->size());
  for (std::size_t k = waypoints_->size(); k-- > 0;) {
    const auto& branches = (*waypoints_)[k];
    if (k + 1 == waypoints_->size()) {
      ahead[k].assign(branches.size(), 0);
      continue;
    }
    const auto& nexts = (*waypoints_)[k + 1];
    for (const IkBranch* branch : branches) {
      double least = kNever;
      for (std::size_t b = 0; b < nexts.size(); ++b) {
        const double size = moves_->min_size(*branch, *nexts[b]);
        if (allowed(size, true)) least = std::min(least, joined(ahead[k + 1][b], size, true));
      }
      ahead[k].push_back(least);
    }
  }
  return ahead;
}

/// What a path comes to that always makes the move which promises most; infinite when it gets
/// stuck.
double LeastPath::some_path(const JointVector& start, const Bounds& ahead) const {
  Place here{{start, nullptr}, 0};
  for (std::size_t k = 0; k < waypoints_->size(); ++k) {
    Place best;
    double least = kNever;
    for (std::size_t b = 0; b < (*waypoints_)[k].size(); ++b) {
      const IkBranch* branch = (*waypoints_)[k][b];
      const auto move = moves_->between(here.at, *branch);
      if (!move || !allowed(move->size, move->counts)) continue;
      const double so_far = joined(here.so_far, move->size, move->counts);
      const double promise = joined(so_far, ahead[k][b], true);
      if (promise < least) best = {{move->q, branch}, so_far}, least = promise;
    }
    if (least == kNever) return kNever;
    here = best;
  }
  return here.so_far;
}

std::vector<Place> LeastPath::next(const std::vector<Place>& places, std::size_t waypoint,
                                   const Bounds& ahead, double bound) const {
  std::vector<Place> reached;
  for (const Place& place : places) {
    for (std::size_t b = 0; b < (*waypoints_)[waypoint].size(); ++b) {
      const IkBranch* branch = (*waypoints_)[waypoint][b];
      const auto move = moves_->between(place.at, *branch);
      if (!move || !allowed(move->size, move->counts)) continue;
      const double so_far = joined(place.so_far, move->size, move->counts);
      if (joined(so_far, ahead[waypoint][b], true) > bound) continue;
      if (Place* known = find(reached, branch, move->q)) {
        known->so_far = std::min(known->so_far, so_far);
      } else {
        reached.push_back({{move->q, branch}, so_far});
      }
    }
  }
  return reached;
}

Layers LeastPath::from(const JointVector& start) const {
  const Bounds ahead = bounds();
  const double bound = some_path(start, ahead) + kEqual;
  Layers layers{{{Place{{start, nullptr}, 0}}}};
  for (std::size_t k = 0; k < waypoints_->size(); ++k) {
    auto reached = next(layers.of.back(), k, ahead, bound);
    if (reached.empty()) break;
    layers.of.push_back(std::move(reached));
  }
  return layers;
}

std::vector<JointVector> LeastPath::first_of(const Layers& layers) const {
  std::vector<JointVector> path(waypoints_->size());
  double budget = layers.least() + kEqual;
  const Place* behind = nullptr;  // the place chosen at the waypoint after
  for (std::size_t k = waypoints_->size(); k > 0; --k) {
    const auto rank = [&](const Place& place) {
      return std::ranges::find((*waypoints_)[k - 1], place.at.branch) -
             (*waypoints_)[k - 1].begin();
    };
    const Place* chosen = nullptr;
    double left = 0;
    for (const Place& place : layers.of[k]) {
      double size = 0;
      if (behind) {
        const auto move = moves_->between(place.at, *behind->at.branch);
        if (!move || move->q != behind->at.q || !allowed(move->size, move->counts)) continue;
        size = move->size;
      }
      if (place.so_far + size > budget) continue;
      if (chosen && rank(*chosen) <= rank(place)) continue;
      chosen = &place;
      left = std::max(budget - size, place.so_far);
    }
    path[k - 1] = chosen->at.q;
    behind = chosen;
    budget = left;
  }
  return path;
}

}  // namespace armature::select::minmax
