// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "armature/kinds/registration/explained_fit.hpp"
#include "armature/kinds/registration/handedness.hpp"
#include "armature/kinds/registration/marker_matching.hpp"
#include "armature/kinds/registration/registration.hpp"
#include "armature/kinds/registration/single_error.hpp"
#include "armature/kinds/registration/target_error.hpp"
#include "armature/kinds/request_host.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/guarded.hpp"
#include "host_registration_parameters.hpp"

namespace armature::host::registration {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points points_of(const std::vector<msg::Point>& message) {
  Points points;
  for (const msg::Point& point : message) points.push_back(to_eigen(point));
  return points;
}

/// All that a request asks for.
struct Answer {
  MarkerMatch match;  // of the image's markers
  Registration found;
  std::vector<PointError> errors;  // of each target
};

Expected<MarkerMatch> matched(const msg::RegistrationRequest& request, const Points& image,
                              const Points& robot) {
  if (!request.ordered_()) return match_markers(image, robot, request.match_tolerance_());
  MarkerMatch same{std::vector<std::size_t>(robot.size())};
  std::iota(same.measured.begin(), same.measured.end(), std::size_t{0});
  return same;
}

/// What would take long: a target's error alone wants six registrations a marker.
std::optional<std::string> too_many(const msg::RegistrationRequest& request) {
  constexpr std::size_t kMost = 64;
  for (const auto& [points, what] :
       {std::pair{&request.image_markers_(), "markers in the image"},
        std::pair{&request.robot_markers_(), "markers before the robot"},
        std::pair{&request.targets_(), "targets"}}) {
    if (points->size() <= kMost) continue;
    return fmt::format("{} {}, {} at most are taken", points->size(), what, kMost);
  }
  return std::nullopt;
}

/// Errors that were predicted from what is stated of the markers become what the markers show
/// themselves: how they fit, and what each of them would do if it were wrong. Returns why they do
/// not show that. Of three nobody can tell it: whoever vouches for them vouches for that as well.
std::optional<std::string> raise_errors(const MarkerPairs& markers,
                                        const msg::RegistrationRequest& request, Answer& answer) {
  const double stated_m = request.marker_error_();
  const double shown_m =
      shown_marker_error(only(markers, markers_that_agree(answer.found, stated_m)), stated_m);
  for (std::size_t i = 0; i < answer.errors.size(); ++i) {
    PointError& error = answer.errors[i];
    if (stated_m > 0) error = point_error(std::pow(shown_m / stated_m, 2) * error.covariance);
    if (markers.image.size() == 3) continue;
    const auto wrong =
        error_with_one_wrong(markers, answer.found, to_eigen(request.targets_()[i]), stated_m);
    if (!wrong) return wrong.error().text;
    error.bound95_m = std::max(error.bound95_m, wrong->bound95_m);
  }
  return std::nullopt;
}

/// Why a plugin's answer cannot be used: all else here counts with the number of markers.
std::optional<std::string> unusable(const Registration& found, std::size_t markers) {
  if (found.used.size() != markers || found.residual_m.size() != markers) {
    return fmt::format("the plugin tells {} markers and {} residuals of {} markers",
                       found.used.size(), found.residual_m.size(), markers);
  }
  if (std::ranges::find(found.used, true) == found.used.end()) {
    return "the plugin tells a map, and that it used no marker";
  }
  if (!found.robot_T_image.matrix().allFinite()) return "the plugin's map is not finite";
  return std::nullopt;
}

Expected<Answer> answer_to(const Registrar& registrar, const Parameters& parameters,
                           const msg::RegistrationRequest& request) {
  if (auto wrong = too_many(request)) return refuse(std::move(*wrong));
  MarkerPairs markers{points_of(request.image_markers_()), {}};
  const Points robot = points_of(request.robot_markers_());
  auto match = matched(request, markers.image, robot);
  if (!match) return tl::unexpected{match.error()};
  for (const std::size_t i : match->measured) markers.robot.push_back(robot[i]);
  auto found = guarded([&] { return registrar.find(markers); });
  if (!found) return tl::unexpected{found.error()};
  if (auto wrong = unusable(*found, markers.image.size())) return refuse(std::move(*wrong));
  Answer answer{std::move(*match), std::move(*found), {}};
  // A marker that was left out passes no error on, and to find it again and again takes long.
  const MarkerPairs used = only(markers, answer.found.used);
  for (const msg::Point& target : request.targets_()) {
    const auto error = guarded([&] {
      return predicted_error(registrar, used, to_eigen(target), request.marker_error_());
    });
    if (!error) return tl::unexpected{error.error()};
    answer.errors.push_back(*error);
  }
  if (answer.errors.empty()) return answer;
  auto unexplained = unexplained_fit(markers, answer.found, request.marker_error_());
  if (unexplained) return refuse(std::move(*unexplained));
  if (!parameters.handedness_vouched) {
    auto unchecked = unchecked_handedness(markers, answer.found, request.marker_error_());
    if (!unchecked) unchecked = exchangeable_handedness(answer.match, request.marker_error_());
    if (unchecked) return refuse(std::move(*unchecked));
  }
  if (auto unchecked = raise_errors(markers, request, answer)) return refuse(std::move(*unchecked));
  return answer;
}

void write(const Answer& answer, const std::vector<msg::Point>& targets,
           msg::RegistrationResponse& response) {
  const Eigen::Affine3d& map = answer.found.robot_T_image;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      response.robot_t_image_()[static_cast<std::size_t>(4 * row + column)] = map(row, column);
    }
  }
  response.robot_marker_().assign(answer.match.measured.begin(), answer.match.measured.end());
  response.used_() = answer.found.used;
  response.residuals_() = answer.found.residual_m;
  response.fre_(answer.found.fre_m);
  response.condition_(answer.found.condition);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    auto& target = response.targets_().emplace_back();
    assign(target.position_(), Eigen::Vector3d{map * to_eigen(targets[i])});
    target.error_rms_(answer.errors[i].rms_m);
    target.error_95_(answer.errors[i].bound95_m);
  }
}

}  // namespace

/// Markers and targets in; the map, and where the targets are before the robot, out. The robot's
/// markers may be told in any frame, a tracked body's as well as the base's: the answer is told in
/// the same one.
class RegistrationHost final
    : public RequestHost<msg::RegistrationRequest, msg::RegistrationResponse> {
 public:
  explicit RegistrationHost(Setup& setup)
      : RequestHost{setup},
        parameters_{Parameters::read(setup.params())},
        registrar_{setup.slot<Registrar>("registrar")} {}

 private:
  void answer(const msg::RegistrationRequest& request,
              msg::RegistrationResponse& response) override {
    respond(answer_to(*registrar_, parameters_, request), response,
            [&](const Answer& found) { write(found, request.targets_(), response); });
  }

  Parameters parameters_;
  Slot<Registrar> registrar_;
};

}  // namespace armature::host::registration

ARMATURE_PLUGIN(armature::host::registration::RegistrationHost);
