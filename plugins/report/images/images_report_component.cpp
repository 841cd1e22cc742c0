// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "armature/values/angles.hpp"
#include "report_images_ports.hpp"

namespace armature::report::images {

/// Errors of the true markers that were found; how many were not, or have no numbers.
struct MarkerErrors {
  int found = 0, missing = 0, unknown = 0;
  double sum2 = 0, max = 0, max_sigmas = 0, min_confidence = 1;  // [m2], [m]

  void add(double error, const msg::ImageMarker& marker) {
    ++found;
    sum2 += error * error;
    max = std::max(max, error);
    if (!std::isfinite(marker.sigma_() + marker.confidence_())) ++unknown;
    max_sigmas = std::max(max_sigmas, error / std::max(marker.sigma_(), 1e-9));
    min_confidence = std::min(min_confidence, marker.confidence_());
  }
};

namespace {

constexpr double kSame = 0.003;  // [m] farther off it is another thing

MarkerErrors errors_of(const msg::NeedlePlan& truth, const msg::ImageMarkers& markers) {
  MarkerErrors errors;
  for (const msg::Point& place : truth.markers_()) {
    const msg::ImageMarker* nearest = nullptr;
    double distance = kSame;
    for (const msg::ImageMarker& marker : markers.markers_()) {
      const double off = (to_eigen(marker.position_()) - to_eigen(place)).norm();
      if (off < distance) distance = off, nearest = &marker;
    }
    if (nearest) {
      errors.add(distance, *nearest);
    } else {
      ++errors.missing;
    }
  }
  return errors;
}

}  // namespace

class ImagesReport final : public Component {
 public:
  explicit ImagesReport(Setup& setup) : Component{setup}, ports_{setup} {
    setup.activate_every(seconds(0.1));
  }

  void step(Time) override {
    if (ports_.anatomy.latest() && ports_.markers.latest()) {
      errors_ = errors_of(*ports_.anatomy.latest(), *ports_.markers.latest());
    }
    if (ports_.ways.latest() && ports_.ways.latest()->valid_()) told_ = *ports_.ways.latest();
    if (told_ && ports_.anatomy.latest()) {
      lesion_error_ =
          (to_eigen(told_->target_()) - to_eigen(ports_.anatomy.latest()->target_())).norm();
    }
  }

  void summarize(Summary& summary) const override {
    if (errors_) summary.metric("markers_found", "markers found in the volume", errors_->found);
    if (errors_ && errors_->found > 0) {
      summary.metric("marker_error_rms_mm", "their error, rms [mm]",
                     1e3 * std::sqrt(errors_->sum2 / errors_->found));
      const std::string missing =
          errors_->missing == 0
              ? ""
              : fmt::format("{} of {} markers were not found to within {:g} mm", errors_->missing,
                            errors_->found + errors_->missing, 1e3 * kSame);
      const std::string unknown = !missing.empty() || errors_->unknown == 0
                                      ? missing
                                      : "a marker's sigma or confidence is no number";
      const auto tell = [&](const char* key, const char* title, double value,
                            const std::string& why_not) {
        if (why_not.empty()) return summary.metric(key, title, value);
        summary.not_measured(key, title, why_not);
      };
      tell("max_marker_error_mm", "the worst one's [mm]", 1e3 * errors_->max, missing);
      tell("max_marker_error_sigmas", "the worst in sigmas", errors_->max_sigmas, unknown);
      tell("min_marker_confidence", "the least confidence", errors_->min_confidence, unknown);
    }
    if (lesion_error_) {
      summary.metric("lesion_error_mm", "error of the lesion's centre [mm]", 1e3 * *lesion_error_);
    }
    if (!told_ || told_->ways_().empty()) return;
    const msg::NeedleWay& best = told_->ways_().front();
    summary.metric("lesion_volume_ml", "volume of the lesion [ml]", 1e6 * told_->lesion_volume_());
    summary.metric("ways_in", "ways in", static_cast<double>(told_->ways_().size()));
    constexpr const char *kVessel = "vessel_distance_mm",
                         *kTitle = "the best one's distance from a vessel [mm]";
    if (std::isinf(best.vessel_distance_())) {
      summary.does_not_apply(kVessel, kTitle, "no vessel was found");
    } else {
      summary.metric(kVessel, kTitle, 1e3 * best.vessel_distance_());
    }
    summary.metric("way_length_mm", "its length [mm]", 1e3 * best.length_());
    summary.metric("skull_angle_deg", "its angle to the skull's normal [deg]",
                   kDegreesPerRad * best.skull_angle_());
  }

  void write_files(const std::filesystem::path& directory) const override {
    if (!told_) return;
    std::string table =
        "entry_x_mm,entry_y_mm,entry_z_mm,length_mm,vessel_distance_mm,skull_angle_deg,cost,"
        "reason\n";
    for (const msg::NeedleWay& way : told_->ways_()) {
      table +=
          fmt::format("{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.2f},{:.3f},\"{}\"\n",
                      1e3 * way.entry_().x_(), 1e3 * way.entry_().y_(), 1e3 * way.entry_().z_(),
                      1e3 * way.length_(), 1e3 * way.vessel_distance_(),
                      kDegreesPerRad * way.skull_angle_(), way.cost_(), way.reason_());
    }
    write_atomically(directory / "needle_ways.csv", table);
  }

 private:
  std::optional<MarkerErrors> errors_;
  std::optional<msg::NeedleWays> told_;
  std::optional<double> lesion_error_;
  Ports ports_;
};

}  // namespace armature::report::images

ARMATURE_PLUGIN(armature::report::images::ImagesReport);
