// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <string>

#include "armature/kinds/volume_messages.hpp"
#include "armature/kinds/zone_messages.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/volume/nrrd.hpp"
#include "ct_head.hpp"

namespace armature::sim::ct_head {
namespace {

namespace fs = std::filesystem;

Anatomy anatomy_of(const msg::NeedlePlan& plan) {
  Anatomy anatomy{
      .markers = {}, .lesion = to_eigen(plan.target_()), .vessels = zones_of(plan.forbidden_())};
  for (const msg::Point& marker : plan.markers_()) anatomy.markers.push_back(to_eigen(marker));
  return anatomy;
}

}  // namespace

/// Scans the first head that it is told of.
class CtHeadComponent final : public Component {
 public:
  explicit CtHeadComponent(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        seed_{setup.seed()},
        file_{parameters_.file.empty()
                  ? fs::temp_directory_path() /
                        fmt::format("armature-{}-{}.nrrd", getpid(), setup.name())
                  : fs::path{parameters_.file}},
        anatomy_{setup.input<msg::NeedlePlan>("anatomy")},
        volume_{setup.output<msg::VolumeFile>("volume")} {}

  ~CtHeadComponent() override {
    std::error_code error;
    if (scanned_ && parameters_.file.empty()) fs::remove(file_, error);
  }

  void step(Time now) override {
    if (scanned_ || !anatomy_.latest()) return;
    const auto volume = scan(anatomy_of(*anatomy_.latest()), parameters_, seed_);
    if (!volume) return degraded(volume.error().text);
    if (const auto written = write_nrrd(*volume, file_); !written) {
      return degraded(written.error().text);
    }
    healthy();
    scanned_ = true;
    const auto& size = volume->geometry.size;
    log(fmt::format("scanned {} x {} x {} voxels", size[0], size[1], size[2]));
    auto message = volume_.loan();
    write_header(message->header_(), now, kImageFrame);
    message->path_(fs::absolute(file_).string());
    message->sha256_(sha256_of(*volume));
    message.publish();
  }

 private:
  Parameters parameters_;
  std::uint64_t seed_;
  fs::path file_;
  bool scanned_ = false;
  Input<msg::NeedlePlan> anatomy_;
  Output<msg::VolumeFile> volume_;
};

}  // namespace armature::sim::ct_head

ARMATURE_PLUGIN(armature::sim::ct_head::CtHeadComponent);
