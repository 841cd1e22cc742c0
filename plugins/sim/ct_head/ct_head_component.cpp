// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "armature/kinds/volume_messages.hpp"
#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/volume/nrrd.hpp"
#include "ct_head.hpp"
#include "sim_ct_head_ports.hpp"

namespace armature::sim::ct_head {
namespace {

namespace fs = std::filesystem;

Anatomy anatomy_of(const msg::NeedlePlan& plan) {
  Anatomy anatomy{
      .markers = {}, .lesion = to_eigen(plan.target_()), .vessels = zones_of(plan.forbidden_())};
  for (const msg::Point& marker : plan.markers_()) anatomy.markers.push_back(to_eigen(marker));
  return anatomy;
}

/// Makes a file that nobody else may read, under a name that nobody can guess: in a folder where
/// everybody may write, a link of somebody else would wait under another one.
Expected<fs::path> new_temporary_file(const std::string& component) {
  constexpr std::string_view kExtension = ".nrrd";
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  if (error)
    return refuse(fmt::format("no folder for temporary files (TMPDIR): {}", error.message()));
  std::string file = folder / fmt::format("armature-{}-XXXXXX{}", component, kExtension);
  const int descriptor = mkstemps(file.data(), static_cast<int>(kExtension.size()));
  if (descriptor < 0) {
    return refuse(fmt::format("'{}' cannot be written: {}; is TMPDIR right?", file,
                              std::generic_category().message(errno)));
  }
  close(descriptor);
  return file;
}

}  // namespace

/// Scans the first head that it is told of.
class CtHeadComponent final : public Component {
 public:
  explicit CtHeadComponent(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        seed_{setup.seed()},
        name_{setup.name()},
        file_{parameters_.file},
        ports_{setup} {}

  ~CtHeadComponent() override {
    std::error_code error;
    if (parameters_.file.empty() && !file_.empty()) fs::remove(file_, error);
  }

  void step(Time now) override {
    if (scanned_ || !ports_.anatomy.latest()) return;
    const auto volume = scan(anatomy_of(*ports_.anatomy.latest()), parameters_, seed_);
    if (!volume) return degraded(volume.error().text);
    if (file_.empty()) {
      auto made = new_temporary_file(name_);
      if (!made) return degraded(made.error().text);
      file_ = std::move(*made);
    }
    if (const auto written = write_nrrd(*volume, file_); !written) {
      return degraded(written.error().text);
    }
    healthy();
    scanned_ = true;
    const auto& size = volume->geometry.size;
    log(fmt::format("scanned {} x {} x {} voxels", size[0], size[1], size[2]));
    auto message = ports_.volume.loan();
    write_header(message->header_(), now, kImageFrame);
    message->path_(fs::absolute(file_).string());
    message->sha256_(sha256_of(*volume));
    message.publish();
  }

 private:
  Parameters parameters_;
  std::uint64_t seed_;
  std::string name_;
  fs::path file_;  // empty: none was made yet
  bool scanned_ = false;
  Ports ports_;
};

}  // namespace armature::sim::ct_head

ARMATURE_PLUGIN(armature::sim::ct_head::CtHeadComponent);
