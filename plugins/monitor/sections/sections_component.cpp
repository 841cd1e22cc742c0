// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "armature/kinds/announced_volume.hpp"
#include "armature/kinds/geometry_params.hpp"
#include "armature/kinds/joint_messages.hpp"
#include "armature/kinds/registered_plan.hpp"
#include "armature/kinds/registration_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/header.hpp"
#include "armature/messages/sensor_msgs.hpp"
#include "armature/robot/kinematics/kinematics.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "drawing.hpp"
#include "monitor_sections_parameters.hpp"
#include "monitor_sections_ports.hpp"
#include "png_encoder.hpp"

namespace armature::monitor::sections {

/// The tool in the image's frame.
struct Tool {
  Time stamp;
  Eigen::Vector3d tip, direction;
};

/// What one of the three pictures shows.
struct Picture {
  View view;
  const char* name;
  const char* normal;  // along which its planes are counted
  int axis;
};

constexpr std::array kPictures{Picture{View::axial, "axial", "z", 2},
                               Picture{View::coronal, "coronal", "y", 1},
                               Picture{View::sagittal, "sagittal", "x", 0}};

class SectionsComponent final : public Component {
 public:
  explicit SectionsComponent(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        robot_{robot_of(setup)},
        needle_axis_{robot_.pointing_axis().value_or(Eigen::Vector3d::UnitZ())},
        ports_{setup},
        announced_{ports_.volume},
        plan_{ports_.plan, ports_.request, ports_.registration},
        images_{ports_.axial, ports_.coronal, ports_.sagittal} {
    if (parameters_.window[0] >= parameters_.window[1]) {
      setup.params().refuse({"window"}, "'window' is black first, then white, which is above it");
    }
    setup.activate_every(seconds(1 / parameters_.rate));
  }

  void step(Time now) override {
    const auto news = plan_.read();
    const bool takes_volume = !volume_ || !plan_.plan() || news.plan;
    if (auto volume = takes_volume ? announced_.take() : std::nullopt) {
      if (*volume) {
        volume_ = std::move(**volume);
        healthy();
      } else {
        volume_.reset();
        degraded(volume->error().text);
      }
    }
    if (news.registration) {
      image_T_robot_.reset();
      if (plan_.registration()) image_T_robot_ = robot_T_image_of(*plan_.registration()).inverse();
    }
    tool_ = tool_now();
    publish_tool(now);
    for (std::size_t i = 0; volume_ && i < kPictures.size(); ++i) {
      if (images_[i].has_subscribers()) publish_picture(i, now);
    }
  }

  /// The sections through the target, with the tool where it is at the end.
  void write_files(const std::filesystem::path& directory) const override {
    if (!volume_) return;
    const bool through_point = parameters_.through == Parameters::Through::point || !plan();
    const Eigen::Vector3d through = through_point ? point() : target();
    for (const Picture& picture : kPictures) {
      const cv::Mat drawn = drawn_through(picture, through);
      write_atomically(directory / fmt::format("section_{}.png", picture.name),
                       png::encoded({.width = drawn.cols,
                                     .height = drawn.rows,
                                     .channels = drawn.channels(),
                                     .data = drawn.data,
                                     .stride = drawn.step}));
    }
  }

 private:
  Expected<Tool> tool_now() const {
    if (!image_T_robot_) return refuse("the image is not registered yet");
    if (!ports_.measured_js.latest())
      return refuse("the arm has not said where it is for the last 0.5 s");
    const msg::JointState& arm = *ports_.measured_js.latest();
    const auto q = joints_of(robot_, arm);
    if (!q) return tl::unexpected{q.error()};
    const Eigen::Isometry3d base_T_tool = forward_kinematics(robot_, *q);
    const Eigen::Vector3d axis = image_T_robot_->linear() * (base_T_tool.linear() * needle_axis_);
    return Tool{stamp_of(arm.header_().stamp_()), *image_T_robot_ * base_T_tool.translation(),
                axis.normalized()};
  }

  Eigen::Vector3d point() const { return vector_of(parameters_.point); }

  /// Null while there is none whose line is finite.
  const msg::NeedlePlan* plan() const {
    return plan_.plan() && (target() + entry()).allFinite() ? plan_.plan() : nullptr;
  }
  Eigen::Vector3d target() const { return to_eigen(plan_.plan()->target_()); }
  Eigen::Vector3d entry() const { return to_eigen(plan_.plan()->entry_()); }

  std::vector<ForbiddenZone> vessels() const {
    return plan() ? zones_of(plan()->forbidden_()) : std::vector<ForbiddenZone>{};
  }

  static double distance_from_line(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                                   const Eigen::Vector3d& b) {
    if ((b - a).norm() < 1e-9) return (point - a).norm();
    return (point - a).cross((b - a).normalized()).norm();
  }

  double vessel_distance(const Eigen::Vector3d& point) const {
    double distance = std::numeric_limits<double>::infinity();
    for (const ForbiddenZone& vessel : vessels()) {
      distance = std::min(distance, clearance(point, point, vessel));
    }
    return distance;
  }

  /// Why nothing can be told of the tool, or "".
  std::string reason() const {
    if (plan_.plan() && !plan()) return "there is no plan of a finite line yet";
    return tool_ ? "" : tool_.error().text;
  }

  void publish_tool(Time now) {
    auto message = ports_.tool.loan();
    *message = msg::ToolInImage{};  // it was used before
    write_header(message->header_(), tool_ ? tool_->stamp : now, kImageFrame);
    message->reason_() = reason();
    message->valid_(message->reason_().empty());
    if (message->valid_()) {
      assign(message->tip_(), tool_->tip);
      assign(message->direction_(), tool_->direction);
      message->target_distance_((tool_->tip - target()).norm());
      message->line_distance_(distance_from_line(tool_->tip, entry(), target()));
      message->vessel_distance_(vessel_distance(tool_->tip));
    }
    message.publish();
  }

  /// What the live sections go through.
  Eigen::Vector3d through_now() const {
    if (parameters_.through == Parameters::Through::point) return point();
    const bool tool_inside = tool_ && volume_->geometry.contains(tool_->tip);
    if (parameters_.through == Parameters::Through::tool && tool_inside) return tool_->tip;
    return plan() ? target() : point();
  }

  Overlay overlay() const {
    Overlay overlay{.plan = {}, .needle = {}, .vessels = vessels()};
    if (plan()) overlay.plan = {entry(), target()};
    if (!tool_) return overlay;
    overlay.needle = {tool_->tip, tool_->tip - parameters_.needle * tool_->direction};
    if (plan()) {
      overlay.texts.push_back(
          fmt::format("to the target {:.1f} mm", 1e3 * (tool_->tip - target()).norm()));
    }
    const double vessel = vessel_distance(tool_->tip);
    if (std::isfinite(vessel)) {
      overlay.texts.push_back(fmt::format("to a vessel {:.1f} mm", 1e3 * vessel));
    }
    return overlay;
  }

  cv::Mat drawn_through(const Picture& picture, const Eigen::Vector3d& through) const {
    const Section section = section_through(picture.view, through, volume_->geometry,
                                            parameters_.view, parameters_.size);
    return drawn(*volume_, section, parameters_.window[0], parameters_.window[1], overlay(),
                 fmt::format("{} {} = {:.1f} mm", picture.name, picture.normal,
                             1e3 * through[picture.axis]));
  }

  void publish_picture(std::size_t i, Time now) {
    const cv::Mat picture = drawn_through(kPictures[i], through_now());
    auto image = images_[i].loan();
    write_header(image->header_(), tool_ ? tool_->stamp : now, kImageFrame);
    image->width_(static_cast<std::uint32_t>(picture.cols));
    image->height_(static_cast<std::uint32_t>(picture.rows));
    image->step_(static_cast<std::uint32_t>(3 * picture.cols));
    image->encoding_("bgr8");
    image->is_bigendian_(0);
    image->data_().assign(picture.datastart, picture.dataend);
    image.publish();
  }

  Parameters parameters_;
  RobotModel robot_;
  Eigen::Vector3d needle_axis_;
  std::optional<Volume> volume_;
  std::optional<Eigen::Affine3d> image_T_robot_;
  Expected<Tool> tool_ = refuse("the image is not registered yet");
  Ports ports_;
  AnnouncedVolume announced_;
  RegisteredPlan<msg::NeedlePlan> plan_;
  std::array<Output<msg::Image>, 3> images_;
};

}  // namespace armature::monitor::sections

ARMATURE_PLUGIN(armature::monitor::sections::SectionsComponent);
