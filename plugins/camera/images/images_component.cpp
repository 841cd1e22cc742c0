// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/runtime/plugins/plugin.hpp"
#include "camera_images_parameters.hpp"
#include "camera_images_ports.hpp"
#include "folder_pictures.hpp"
#include "recorded_pictures.hpp"

namespace armature::camera::images {
namespace {

constexpr Duration kLookEvery = seconds(0.001);
constexpr int kMaxPicturesAStep = 2;  // a pair: what came late is caught up in several steps
constexpr int kMaxBadAPicture = 4;    // that are left out before it in a step

std::unique_ptr<pictures::PictureSource> source_of(const Parameters& parameters) {
  const bool folders = !parameters.left.empty() || !parameters.right.empty();
  if (folders == !parameters.recording.empty()) {
    throw SetupError(folders ? "both folders and a recording are given; keep one"
                             : "there is nothing to play; set left and right (folders), or "
                               "recording (an MCAP file)");
  }
  if (!folders) {
    if (!parameters.timestamps.empty()) {
      throw SetupError("timestamps: a recording has times of its own; leave timestamps out");
    }
    return std::make_unique<RecordedPictures>(parameters.recording, parameters.left_topic,
                                              parameters.right_topic);
  }
  for (const auto& [name, folder] :
       {std::pair{"left", parameters.left}, std::pair{"right", parameters.right}}) {
    if (std::error_code error; !std::filesystem::is_directory(folder, error)) {
      throw SetupError(fmt::format("{}: there is no folder '{}'", name, folder));
    }
  }
  return std::make_unique<pictures::FolderPictures>(pictures::FolderPictures::Options{
      .left = parameters.left,
      .right = parameters.right,
      .timestamps = parameters.timestamps,
      .interval = seconds(1 / parameters.rate),
      .skip = parameters.bad_pictures == Parameters::BadPictures::skip});
}

}  // namespace

/// Two cameras, as they were.
class Images final : public Component {
 public:
  explicit Images(Setup& setup)
      : Component{setup},
        parameters_{Parameters::read(setup.params())},
        source_{source_of(parameters_)},
        ports_{setup} {
    setup.activate_every(kLookEvery);
  }

  void step(Time now) override;
  bool finished() const override { return finished_; }
  void summarize(Summary& summary) const override;

 private:
  void fetch();
  bool is_usable(const pictures::TimedPicture& timed);
  void go_round(Time now);
  void publish(Time now);

  Parameters parameters_;
  std::unique_ptr<pictures::PictureSource> source_;
  Ports ports_;
  std::optional<pictures::TimedPicture> next_;
  bool told_left_out_ = false, begun_ = false, exhausted_ = false, finished_ = false;
  Time first_;         // when the first picture came, by the clock of the source
  Duration shift_{0};  // from the source's clock to the deployment's
  Time end_;           // when the last picture is over, by the deployment's clock
  int width_ = 0, height_ = 0;
  std::string refusal_;
  std::uint64_t published_ = 0, published_before_round_ = 0, skipped_ = 0;
  Duration max_lateness_{0};
};

/// True for a picture that may be published; any other is refused, or counted.
bool Images::is_usable(const pictures::TimedPicture& timed) {
  std::string why = timed.picture ? std::string{} : timed.picture.error().text;
  if (timed.picture) {
    const int width = timed.picture->width, height = timed.picture->height;
    if (width_ == 0) {
      width_ = width;
      height_ = height;
    }
    if (width == width_ && height == height_) return true;
    why =
        fmt::format("the {} picture stamped {:.6f} s has {} x {} pixels, the first one has {} x {}",
                    timed.side == pictures::Side::left ? "left" : "right",
                    to_seconds(timed.stamp - Time{}), width, height, width_, height_);
  }
  if (parameters_.bad_pictures == Parameters::BadPictures::refuse) {
    refusal_ = why + "; bad_pictures: skip leaves such a picture out";
    return false;
  }
  ++skipped_;
  log("left out: " + why);
  return false;
}

/// Reads the next picture that can be used; a step does not look further than to a few that cannot.
void Images::fetch() {
  for (int bad = 0; bad <= kMaxBadAPicture && !next_ && !exhausted_ && refusal_.empty(); ++bad) {
    auto timed = source_->next();
    if (timed && is_usable(*timed)) next_ = std::move(timed);
    if (timed) continue;
    exhausted_ = !source_->has_more();
    return;
  }
}

void Images::step(Time now) {
  if (finished_) return;
  if (!std::exchange(told_left_out_, true)) {
    skipped_ += source_->left_out();
    if (const std::string remark = source_->remark(); !remark.empty()) log("left out: " + remark);
  }
  for (int i = 0; i < kMaxPicturesAStep; ++i) {
    fetch();
    if (exhausted_ && !next_) go_round(now);
    if (!next_) break;
    if (!begun_) {
      begun_ = true;
      first_ = next_->published;
      shift_ = now + seconds(parameters_.start) - first_;
    }
    if (next_->published + shift_ > now) break;
    publish(now);
  }
  if (!refusal_.empty()) {
    degraded(refusal_);
    finished_ = true;
  }
}

/// After the last picture: what `at_end` says.
void Images::go_round(Time now) {
  if (published_ == published_before_round_) {
    const std::string remark = source_->remark();
    refusal_ = "there is no picture that can be used" + (remark.empty() ? "" : "; " + remark);
    return;
  }
  if (parameters_.at_end == Parameters::AtEnd::loop) {
    shift_ = end_ - first_;
    published_before_round_ = published_;
    exhausted_ = false;
    source_->rewind();
    return fetch();
  }
  log(fmt::format("{} pictures were played{}", published_,
                  source_->remark().empty() ? "" : "; " + source_->remark()));
  finished_ = parameters_.at_end == Parameters::AtEnd::end_run && now >= end_;
}

void Images::publish(Time now) {
  const bool left = next_->side == pictures::Side::left;
  const Time due = next_->published + shift_;
  auto image = (left ? ports_.left_image : ports_.right_image).loan();
  write_header(image->header_(), next_->stamp + shift_,
               left ? parameters_.left_frame : parameters_.right_frame);
  image->width_() = image->step_() = static_cast<std::uint32_t>(next_->picture->width);
  image->height_() = static_cast<std::uint32_t>(next_->picture->height);
  image->encoding_() = "mono8";
  image->is_bigendian_() = 0;
  image->data_() = std::move(next_->picture->pixels);
  image.publish();
  ++published_;
  max_lateness_ = std::max(max_lateness_, now - due);
  end_ = due + source_->last_interval();
  next_.reset();
}

void Images::summarize(Summary& summary) const {
  summary.metric("pictures", "pictures", static_cast<double>(published_));
  summary.metric("pictures_skipped", "pictures left out", static_cast<double>(skipped_));
  summary.metric("max_lateness_ms", "latest picture, after its time [ms]",
                 1e3 * to_seconds(max_lateness_));
  if (!refusal_.empty()) summary.failed("refused", refusal_);
}

}  // namespace armature::camera::images

ARMATURE_PLUGIN(armature::camera::images::Images);
