// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/announced_volume.hpp"
#include "armature/kinds/markers/markers.hpp"
#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "armature/values/guarded.hpp"
#include "host_markers_ports.hpp"

namespace armature::host::markers {
namespace {

void write(const std::vector<FoundMarker>& found, std::vector<msg::ImageMarker>& messages) {
  for (const FoundMarker& marker : found) {
    msg::ImageMarker& message = messages.emplace_back();
    assign(message.position_(), marker.centre);
    message.radius_(marker.radius);
    message.sigma_(marker.sigma);
    message.confidence_(marker.confidence);
  }
}

}  // namespace

/// A volume in; the markers in it out.
class MarkersHost final : public Component {
 public:
  explicit MarkersHost(Setup& setup)
      : Component{setup},
        ports_{setup},
        volume_{ports_.volume},
        finder_{setup.slot<MarkerFinder>("finder")} {}

  void step(Time) override {
    const auto volume = volume_.take();
    if (!volume) return;
    const auto found = search(*volume);
    auto message = ports_.markers.loan();
    *message = msg::ImageMarkers{};  // it was used before
    write_header(message->header_(), *volume_.stamp(), kImageFrame);
    message->valid_(found.has_value());
    if (found) {
      healthy();
      write(*found, message->markers_());
    } else {
      degraded(found.error().text);
      message->reason_() = found.error().text;
    }
    message.publish();
  }

 private:
  Expected<std::vector<FoundMarker>> search(const Expected<Volume>& volume) {
    if (!volume) return tl::unexpected{volume.error()};
    return guarded([&] { return finder_->find(*volume); });
  }

  Ports ports_;
  AnnouncedVolume volume_;
  Slot<MarkerFinder> finder_;
};

}  // namespace armature::host::markers

ARMATURE_PLUGIN(armature::host::markers::MarkersHost);
