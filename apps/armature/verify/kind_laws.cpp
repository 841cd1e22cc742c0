// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <utility>

#include "armature/kinds/detector/laws.hpp"
#include "armature/kinds/drawn_face.hpp"
#include "armature/kinds/face_pose/laws.hpp"
#include "armature/kinds/landmarks/laws.hpp"
#include "armature/kinds/markers/laws.hpp"
#include "armature/kinds/path/laws.hpp"
#include "armature/kinds/registration/laws.hpp"
#include "armature/kinds/select/laws.hpp"
#include "armature/kinds/target/laws.hpp"
#include "armature/kinds/trajectory/laws.hpp"
#include "exit_code.hpp"
#include "plugin_laws.hpp"

namespace armature {
namespace {

bool provides(const PluginManifest& plugin, std::string_view word) {
  return std::ranges::find(plugin.provided, word, &Capability::word) != plugin.provided.end();
}

/// The laws of a kind on subjects that `make` makes.
template <class Subject>
class LawsOfKind final : public PluginLaws {
 public:
  using Make = std::function<Expected<Subject>()>;

  LawsOfKind(std::span<const Law<Subject>> laws, Make make) : laws_{laws}, make_{std::move(make)} {}

  std::string refusal() override {
    const auto made = make_();
    return made ? "" : made.error().text;
  }
  std::vector<LawRun> laws() override {
    std::vector<LawRun> runs;
    for (const Law<Subject>& law : laws_) {
      runs.push_back({std::string{law.says}, [this, &law] {
                        const auto made = make_();
                        if (!made)
                          throw std::runtime_error("refused this time: " + made.error().text);
                        return check_law(law, *made);
                      }});
    }
    return runs;
  }

 private:
  std::span<const Law<Subject>> laws_;
  Make make_;
};

/// Makes plugins of one kind with checked parameters, for a robot where the kind wants one.
class Maker {
 public:
  explicit Maker(const VerifiedPlugin& verified)
      : plugins_{verified.search_path},
        plugin_{*plugins_.find(verified.id)},
        params_{params_of(plugin_, verified.options.params)} {
    if (!verified.arm.robot.empty()) {
      model_ = std::make_shared<const RobotModel>(load_arm(verified.arm));
    }
  }

  const PluginManifest& plugin() const { return plugin_; }
  const std::shared_ptr<const RobotModel>& model() const { return model_; }

  /// The library stays loaded as long as what was made.
  template <class Kind>
  Expected<std::shared_ptr<Kind>> make() {
    auto made = [&] {
      if constexpr (std::same_as<typename Kind::Factory, MadeForRobot<Kind>>) {
        return plugins_.make<Kind>(plugin_.id, *model_, params_);
      } else {
        return plugins_.make<Kind>(plugin_.id, params_);
      }
    }();
    if (!made) return tl::unexpected{made.error()};
    auto held = std::make_shared<PluginPtr<Kind>>(std::move(*made));
    return std::shared_ptr<Kind>{held, &**held};
  }

 private:
  PluginRegistry plugins_;
  const PluginManifest& plugin_;
  Params params_;
  std::shared_ptr<const RobotModel> model_;
};

/// `subject` makes a subject of the laws from a plugin that was made and its maker.
template <class Kind, class Subject, class MakeSubject>
std::unique_ptr<PluginLaws> laws_with(const VerifiedPlugin& verified,
                                      std::span<const Law<Subject>> laws, MakeSubject subject) {
  auto maker = std::make_shared<Maker>(verified);
  return std::make_unique<LawsOfKind<Subject>>(laws, [maker, subject]() -> Expected<Subject> {
    auto made = maker->make<Kind>();
    if (!made) return tl::unexpected{made.error()};
    return subject(*maker, *made);
  });
}

/// The fewest markers that it takes.
std::size_t min_markers(const Registrar& registrar) {
  const std::array<Eigen::Vector3d, 6> places{
      Eigen::Vector3d{0.08, 0, 0.1}, {-0.08, 0.01, 0.09}, {0, 0.1, 0.12},
      {0.01, -0.09, 0.05},           {0.05, 0.05, 0.16},  {-0.04, -0.03, 0.01}};
  MarkerPairs markers;
  for (const Eigen::Vector3d& place : places) {
    markers.image.push_back(place);
    markers.robot.push_back(place);
    if (registrar.find(markers)) break;
  }
  return markers.image.size();
}

std::unique_ptr<PluginLaws> laws_of_path(const VerifiedPlugin& verified) {
  return laws_with<PathPlanner>(verified, path_laws(), [](const Maker& maker, auto planner) {
    return PathSubject{.name = maker.plugin().id,
                       .planner = planner,
                       .along_a_line = provides(maker.plugin(), "along_a_line"),
                       .model = maker.model()};
  });
}
std::unique_ptr<PluginLaws> laws_of_select(const VerifiedPlugin& verified) {
  return laws_with<BranchSelector>(verified, select_laws(), [](const Maker& maker, auto selector) {
    return SelectSubject{.name = maker.plugin().id, .model = maker.model(), .selector = selector};
  });
}
std::unique_ptr<PluginLaws> laws_of_trajectory(const VerifiedPlugin& verified) {
  return laws_with<TrajectoryPlanner>(
      verified, trajectory_laws(), [](const Maker& maker, auto planner) {
        return TrajectorySubject{.name = maker.plugin().id,
                                 .planner = planner,
                                 .provides_time_law = provides(maker.plugin(), "time_law")};
      });
}
std::unique_ptr<PluginLaws> laws_of_registration(const VerifiedPlugin& verified) {
  return laws_with<Registrar>(
      verified, registration_laws(), [](const Maker& maker, auto registrar) {
        return RegistrationSubject{
            .name = maker.plugin().id, .registrar = registrar, .least = min_markers(*registrar)};
      });
}
std::unique_ptr<PluginLaws> laws_of_target(const VerifiedPlugin& verified) {
  return laws_with<TargetFilter>(verified, target_laws(), [](const Maker& maker, auto filter) {
    return TargetSubject{.name = maker.plugin().id, .filter = filter};
  });
}
std::unique_ptr<PluginLaws> laws_of_face_pose(const VerifiedPlugin& verified) {
  return laws_with<FacePoseEstimator>(
      verified, face_pose_laws(), [](const Maker& maker, auto estimator) {
        return FacePoseSubject{.name = maker.plugin().id, .estimator = estimator};
      });
}
std::unique_ptr<PluginLaws> laws_of_detector(const VerifiedPlugin& verified) {
  return laws_with<FaceDetector>(verified, detector_laws(), [](const Maker& maker, auto detector) {
    const DrawnPortrait drawn;
    return DetectorSubject{.name = maker.plugin().id,
                           .detector = [detector]() -> FaceDetector& { return *detector; },
                           .face = [picture = drawn.picture] { return picture; },
                           .middle_x = drawn.middle.x(),
                           .middle_y = drawn.middle.y()};
  });
}
std::unique_ptr<PluginLaws> laws_of_landmarks(const VerifiedPlugin& verified) {
  return laws_with<LandmarkFinder>(verified, landmark_laws(), [](const Maker& maker, auto finder) {
    const DrawnPortrait drawn;
    return LandmarkSubject{.name = maker.plugin().id,
                           .finder = [finder]() -> LandmarkFinder& { return *finder; },
                           .face = [picture = drawn.picture] { return picture; },
                           .box = drawn.box};
  });
}

std::unique_ptr<PluginLaws> laws_of_markers(const VerifiedPlugin& verified) {
  return laws_with<MarkerFinder>(verified, marker_laws(), [](const Maker& maker, auto finder) {
    return MarkerSubject{.name = maker.plugin().id, .finder = finder};
  });
}

struct KindWithLaws {
  std::string_view kind;
  bool for_robot;
  std::unique_ptr<PluginLaws> (*laws)(const VerifiedPlugin&);
};
constexpr std::array kKinds{
    KindWithLaws{"component", false, laws_of_component},
    KindWithLaws{"detector", false, laws_of_detector},
    KindWithLaws{"face_pose", false, laws_of_face_pose},
    KindWithLaws{"ik", true, laws_of_ik},
    KindWithLaws{"landmarks", false, laws_of_landmarks},
    KindWithLaws{"markers", false, laws_of_markers},
    KindWithLaws{"path", true, laws_of_path},
    KindWithLaws{"registration", false, laws_of_registration},
    KindWithLaws{"select", true, laws_of_select},
    KindWithLaws{"target", false, laws_of_target},
    KindWithLaws{"trajectory", false, laws_of_trajectory},
};

}  // namespace

bool is_made_for_robot(const PluginManifest& plugin) {
  const auto kind = std::ranges::find(kKinds, plugin.kind, &KindWithLaws::kind);
  return (kind != kKinds.end() && kind->for_robot) ||
         std::ranges::find(plugin.uses, "robot") != plugin.uses.end();
}

std::unique_ptr<PluginLaws> laws_of(const VerifiedPlugin& verified) {
  const PluginRegistry plugins{verified.search_path};
  const PluginManifest& plugin = *plugins.find(verified.id);
  const auto kind = std::ranges::find(kKinds, plugin.kind, &KindWithLaws::kind);
  if (kind == kKinds.end()) {
    throw InvalidChoice(
        fmt::format("'{}' is of kind '{}', for which there are no laws", plugin.id, plugin.kind));
  }
  return kind->laws(verified);
}

}  // namespace armature
