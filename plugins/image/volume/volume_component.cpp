// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "armature/kinds/volume_messages.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/volume/read_volume.hpp"
#include "image_volume_parameters.hpp"
#include "image_volume_ports.hpp"

namespace armature::image::volume {

/// Announces the volume of its path once.
class VolumeComponent final : public Component {
 public:
  explicit VolumeComponent(Setup& setup)
      : Component{setup}, parameters_{Parameters::read(setup.params())}, ports_{setup} {
    if (std::error_code error; !std::filesystem::exists(parameters_.path, error)) {
      throw SetupError(
          fmt::format("path: there is no '{}'; it is an NRRD file, or the folder of a "
                      "DICOM series",
                      parameters_.path));
    }
    setup.activate_every(seconds(0.1));
  }

  void step(Time now) override {
    if (read_) return;
    read_ = true;
    const auto volume = read_volume(parameters_.path);
    if (!volume) {
      refusal_ = volume.error().text;
      return degraded(refusal_);
    }
    const auto& size = volume->geometry.size;
    const Eigen::Vector3d mm = 1e3 * volume->geometry.spacing;
    log(fmt::format("{} x {} x {} voxels of {:g} x {:g} x {:g} mm", size[0], size[1], size[2],
                    mm.x(), mm.y(), mm.z()));
    auto message = ports_.volume.loan();
    write_header(message->header_(), now, kImageFrame);
    message->path_(std::filesystem::absolute(parameters_.path).string());
    message->sha256_(sha256_of(*volume));
    message.publish();
  }

  /// Without a volume nothing goes on.
  bool finished() const override { return !refusal_.empty(); }
  void summarize(Summary& summary) const override {
    if (!refusal_.empty()) summary.failed("refused", refusal_);
  }

 private:
  Parameters parameters_;
  bool read_ = false;
  std::string refusal_;
  Ports ports_;
};

}  // namespace armature::image::volume

ARMATURE_PLUGIN(armature::image::volume::VolumeComponent);
