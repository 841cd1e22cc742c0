// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/kinds/landmarks/landmark_messages.hpp"
#include "armature/kinds/setup_robot.hpp"
#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "calibrated_pair.hpp"
#include "camera_stereo_pair_parameters.hpp"
#include "camera_stereo_pair_ports.hpp"
#include "pair_matcher.hpp"

namespace armature::camera::stereo_pair {
namespace {

constexpr Duration kLookEvery = seconds(0.1);
constexpr Duration kTellEvery = seconds(1);

const char* name_of(Side side) { return side == Side::left ? "left" : "right"; }

}  // namespace

/// Raw pictures in, a rectified pair out.
class StereoPair final : public Component {
 public:
  explicit StereoPair(Setup& setup);

  void step(Time now) override;
  std::vector<std::string> notes_for_check() const override { return {pair_.description()}; }
  void summarize(Summary& summary) const override;

 private:
  void take(Side side, const Input<msg::Image>& raw, Time now);
  void publish(const MatchedPair& matched, Time now);
  std::string why_unusable(Side side, const Expected<ImageView>& view) const;
  void publish_info(Time stamp);
  void publish_picture(Side side, const ImageView& raw, Time stamp);
  bool is_missed(std::size_t side, Time now) const;
  std::string trouble(Time now) const;
  void tell(Time now);

  Parameters parameters_;
  CalibratedPair pair_;
  PairMatcher matcher_;
  Ports ports_;
  std::array<std::optional<Time>, 2> heard_;  // of each camera; at first when it was waited for
  std::array<bool, 2> missed_{};  // when the pictures were turned off, and not heard since
  bool was_off_ = false;
  struct Refusal {
    Time at;
    std::string reason;
  };
  std::optional<Time> unpaired_at_, told_;
  std::optional<Refusal> refusal_;  // the last one
  std::uint64_t pairs_ = 0, refused_ = 0;
  Duration max_skew_{0};
};

StereoPair::StereoPair(Setup& setup)
    : Component{setup},
      parameters_{Parameters::read(setup.params())},
      pair_{parameters_, optional_rig_of(setup)},
      matcher_{seconds(parameters_.max_skew)},
      ports_{setup} {
  setup.activate_every(kLookEvery);
}

void StereoPair::step(Time now) {
  const bool off = ports_.capture.latest() && !ports_.capture.latest()->on_();
  const bool turned_off = off && !std::exchange(was_off_, off);
  for (std::size_t side = 0; side < heard_.size(); ++side) {
    if (turned_off) missed_[side] = is_missed(side, now);
    // While nobody wants pictures, none is missing; a camera that was silent before stays named.
    if (!heard_[side] || (off && !missed_[side])) heard_[side] = now;
  }
  was_off_ = off;
  const std::uint64_t unpaired = matcher_.unpaired();
  take(Side::left, ports_.left_raw, now);
  take(Side::right, ports_.right_raw, now);
  while (const auto matched = matcher_.next()) {
    if (!off) publish(*matched, now);
  }
  if (matcher_.unpaired() > unpaired) unpaired_at_ = now;
  tell(now);
}

void StereoPair::take(Side side, const Input<msg::Image>& raw, Time now) {
  if (!raw.fresh()) return;
  heard_[static_cast<std::size_t>(side)] = now;
  missed_[static_cast<std::size_t>(side)] = false;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    matcher_.add(side, {.stamp = stamp_of(raw[i].header_().stamp_()), .picture = raw.sample(i)});
  }
}

/// Empty: a picture can be rectified.
std::string StereoPair::why_unusable(Side side, const Expected<ImageView>& view) const {
  if (!view) return fmt::format("{}: {}", name_of(side), view.error().text);
  const StereoCamera& camera = pair_.camera();
  if (view->width == camera.width && view->height == camera.height) return {};
  return fmt::format("the {} picture has {} x {} pixels, and the calibration is of {} x {}",
                     name_of(side), view->width, view->height, camera.width, camera.height);
}

void StereoPair::publish(const MatchedPair& matched, Time now) {
  std::array<ImageView, 2> views;
  for (const auto& [side, picture] :
       {std::pair{Side::left, &matched.left}, {Side::right, &matched.right}}) {
    const auto view = image_of(*static_cast<const msg::Image*>(picture->picture.message()));
    if (std::string reason = why_unusable(side, view); !reason.empty()) {
      refusal_ = {.at = now, .reason = std::move(reason)};
      ++refused_;
      return;
    }
    views[static_cast<std::size_t>(side)] = *view;
  }
  if (pairs_++ == 0) publish_info(matched.stamp());
  publish_picture(Side::left, views[0], matched.stamp());
  publish_picture(Side::right, views[1], matched.stamp());
  max_skew_ = std::max(max_skew_, matched.skew());
}

void StereoPair::publish_info(Time stamp) {
  ports_.left_info.publish(pair_.info(Side::left, stamp));
  ports_.right_info.publish(pair_.info(Side::right, stamp));
}

void StereoPair::publish_picture(Side side, const ImageView& raw, Time stamp) {
  auto image = (side == Side::left ? ports_.left_image : ports_.right_image).loan();
  write_header(image->header_(), stamp, kLeftCameraFrame);
  image->width_() = image->step_() = static_cast<std::uint32_t>(raw.width);
  image->height_() = static_cast<std::uint32_t>(raw.height);
  image->encoding_() = "mono8";
  image->is_bigendian_() = 0;
  pair_.rectify(side, raw, image->data_());
  image.publish();
}

bool StereoPair::is_missed(std::size_t side, Time now) const {
  return heard_[side] && now - *heard_[side] >= seconds(parameters_.timeout);
}

/// What is wrong now, or was a moment ago; empty: nothing.
std::string StereoPair::trouble(Time now) const {
  for (const Side side : {Side::left, Side::right}) {
    if (!is_missed(static_cast<std::size_t>(side), now)) continue;
    return fmt::format("no picture of the {} camera for {:g} s", name_of(side),
                       parameters_.timeout);
  }
  if (refusal_ && now - refusal_->at < kTellEvery) {
    return fmt::format("{}; pairs refused: {}", refusal_->reason, refused_);
  }
  if (unpaired_at_ && now - *unpaired_at_ < kTellEvery) {
    const auto distance = matcher_.last_distance();
    return fmt::format("pictures without a partner within max_skew_ms ({:g}): {}; {}",
                       1e3 * parameters_.max_skew, matcher_.unpaired(),
                       distance ? fmt::format("the last one's nearest is {:.1f} ms away",
                                              1e3 * to_seconds(*distance))
                                : "of the other camera there is none");
  }
  return {};
}

void StereoPair::tell(Time now) {
  const std::string what = trouble(now);
  if (what.empty()) {
    told_.reset();
    return healthy();
  }
  if (told_ && now - *told_ < kTellEvery) return;
  told_ = now;
  degraded(what);
}

void StereoPair::summarize(Summary& summary) const {
  summary.metric("pairs", "pairs", static_cast<double>(pairs_));
  summary.metric("unpaired_pictures", "pictures without a partner",
                 static_cast<double>(matcher_.unpaired()));
  summary.metric("refused_pairs", "pairs of another size or encoding",
                 static_cast<double>(refused_));
  summary.metric("max_pair_skew_ms", "stamps of a pair apart, at most [ms]",
                 1e3 * to_seconds(max_skew_));
}

}  // namespace armature::camera::stereo_pair

ARMATURE_PLUGIN(armature::camera::stereo_pair::StereoPair);
