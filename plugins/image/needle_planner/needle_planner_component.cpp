// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include "anatomy.hpp"
#include "armature/kinds/announced_volume.hpp"
#include "armature/kinds/geometry_params.hpp"
#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "head_ball.hpp"
#include "image_needle_planner_ports.hpp"
#include "ways.hpp"

namespace armature::image::needle_planner {
namespace {

using Eigen::Vector3d;

Parameters parameters_of(const Params& params) {
  const Parameters parameters = Parameters::read(params);
  if (!parameters.lesion_near.empty() && parameters.lesion_near.size() != 3) {
    params.refuse({"lesion_near_mm"}, fmt::format("'lesion_near_mm' has {} numbers; it is x, y, z, "
                                                  "or nothing",
                                                  parameters.lesion_near.size()));
  }
  if (vector_of(parameters.approach).norm() < 1e-6) {
    params.refuse({"approach"}, "'approach' is no direction");
  }
  return parameters;
}

/// What is planned on one volume.
struct Planned {
  Lesion lesion;
  std::vector<ForbiddenZone> vessels;
  ForbiddenZone head;
  std::vector<Way> ways;
};

/// Balls about the markers that a needle and its guide leave free.
std::vector<ForbiddenZone> zones_about(const std::vector<msg::ImageMarker>& markers) {
  constexpr double kGuide = 0.003;  // [m]
  std::vector<ForbiddenZone> zones;
  for (const msg::ImageMarker& marker : markers) {
    const Vector3d centre = to_eigen(marker.position_());
    zones.push_back({"marker", centre, centre, marker.radius_() + kGuide});
  }
  return zones;
}

std::optional<std::string> wrong_count(std::size_t found, int expected) {
  if (found == static_cast<std::size_t>(expected)) return std::nullopt;
  if (found == 0) return "no marker was found in the volume";
  return fmt::format(
      "{} of {} markers were found in the volume{}", found, expected,
      found > static_cast<std::size_t>(expected) ? ": something else looks like one" : "");
}

}  // namespace

/// Plans once for every volume.
class NeedlePlanner final : public Component {
 public:
  explicit NeedlePlanner(Setup& setup)
      : Component{setup},
        parameters_{parameters_of(setup.params())},
        ports_{setup},
        volume_{ports_.volume} {}

  void step(Time) override {
    const auto stamp = volume_.stamp();
    const msg::ImageMarkers* markers = ports_.markers.latest();
    if (!stamp || !markers) return;
    if (stamp_of(markers->header_().stamp_()) != *stamp) return;  // of another volume
    const auto volume = volume_.take();
    if (!volume) return;
    const auto planned = plan_on(*volume, *markers);
    refusal_ = planned ? "" : planned.error().text;
    publish_ways(planned, *stamp);
    if (!planned) return degraded(refusal_);
    healthy();
    log(fmt::format("{} ways in; the best: {}", planned->ways.size(),
                    reason_of(planned->ways.front())));
    publish_plan(*planned, *stamp);
  }

  /// Without a plan nothing goes on.
  bool finished() const override { return !refusal_.empty(); }
  void summarize(Summary& summary) const override {
    if (!refusal_.empty()) summary.failed("refused", refusal_);
  }

 private:
  Expected<Planned> plan_on(const Expected<Volume>& volume,
                            const msg::ImageMarkers& markers) const {
    if (!volume) return tl::unexpected{volume.error()};
    if (!markers.valid_()) return refuse(markers.reason_());
    if (auto wrong = wrong_count(markers.markers_().size(), parameters_.markers)) {
      return refuse(*wrong);
    }
    const auto lesion = find_lesion(*volume, parameters_);
    if (!lesion) return tl::unexpected{lesion.error()};
    const std::vector<ForbiddenZone> balls = zones_about(markers.markers_());
    const auto head = find_head(*volume, balls);
    if (!head) return tl::unexpected{head.error()};
    Planned planned{*lesion, find_vessels(*volume, parameters_), *head, {}};
    auto ways = ways_to(lesion->centre, *volume, planned.vessels, balls, parameters_);
    if (!ways) return tl::unexpected{ways.error()};
    planned.ways = std::move(*ways);
    return planned;
  }

  void publish_ways(const Expected<Planned>& planned, Time stamp) {
    auto message = ports_.ways.loan();
    *message = msg::NeedleWays{};  // it was used before
    write_header(message->header_(), stamp, kImageFrame);
    message->valid_(planned.has_value());
    if (planned) {
      assign(message->target_(), planned->lesion.centre);
      message->lesion_volume_(planned->lesion.volume);
      for (const Way& way : planned->ways) {
        msg::NeedleWay& told = message->ways_().emplace_back();
        assign(told.entry_(), way.entry);
        told.length_(way.length);
        told.vessel_distance_(way.vessel_distance);
        told.skull_angle_(way.skull_angle);
        told.cost_(way.cost);
        told.reason_(reason_of(way));
      }
    } else {
      message->reason_() = planned.error().text;
    }
    message.publish();
  }

  void publish_plan(const Planned& planned, Time stamp) {
    auto message = ports_.plan.loan();
    *message = msg::NeedlePlan{};
    write_header(message->header_(), stamp, kImageFrame);
    for (const msg::ImageMarker& marker : ports_.markers.latest()->markers_()) {
      message->markers_().push_back(marker.position_());
    }
    assign(message->entry_(), planned.ways.front().entry);
    assign(message->target_(), planned.lesion.centre);
    write_zones(planned.vessels, message->forbidden_());
    write_zones({planned.head}, message->head_());
    message.publish();
  }

  Parameters parameters_;
  std::string refusal_;
  Ports ports_;
  AnnouncedVolume volume_;
};

}  // namespace armature::image::needle_planner

ARMATURE_PLUGIN(armature::image::needle_planner::NeedlePlanner);
