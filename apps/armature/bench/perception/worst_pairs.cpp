// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/worst_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>

#include "armature/messages/sensor_msgs.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "bench/perception/perception_report.hpp"
#include "bench/perception/stage.hpp"
#include "jpeg_encoder.hpp"

namespace armature::bench {
namespace {

constexpr std::size_t kWorst = 12;
constexpr double kNormal_m = 0.05;  // as it is drawn
constexpr int kJpegQuality = 90;

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kGreen{40, 220, 60}, kRed{255, 50, 40};

/// How far a result is off: 1 is just wrong.
double badness(const PairResult& result) {
  const double bad = std::max(result.drawn.mouth_m / kMaxMouthError_m,
                              result.drawn.normal_rad / kMaxNormalError_rad);
  return std::isfinite(bad) ? bad : 1e9;
}

/// Both pictures side by side, in colour.
class Sheet {
 public:
  explicit Sheet(const StagedPair& pair) : width_{pair.left.width + pair.right.width} {
    image_.width_(static_cast<std::uint32_t>(width_));
    image_.height_(static_cast<std::uint32_t>(pair.left.height));
    image_.step_(3 * image_.width_());
    image_.encoding_("rgb8");
    image_.data_().resize(std::size_t{image_.step_()} * image_.height_());
    copy(pair.left, 0);
    copy(pair.right, pair.left.width);
  }
  const msg::Image& image() const { return image_; }

  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Colour& colour) {
    if (!from.allFinite() || !to.allFinite()) return;
    const double steps = std::min(std::ceil((to - from).cwiseAbs().maxCoeff()), 4000.0) + 1;
    for (double i = 0; i <= steps; ++i) set(from + i / steps * (to - from), colour);
  }
  void cross(const Eigen::Vector2d& at, const Colour& colour) {
    constexpr double kArm = 6;
    line(at - Eigen::Vector2d{kArm, 0}, at + Eigen::Vector2d{kArm, 0}, colour);
    line(at - Eigen::Vector2d{0, kArm}, at + Eigen::Vector2d{0, kArm}, colour);
  }

 private:
  void copy(const Picture& from, int left) {
    for (int v = 0; v < from.height; ++v) {
      for (int u = 0; u < from.width; ++u) {
        const std::uint8_t grey = from.pixels[static_cast<std::size_t>(v * from.width + u)];
        set(Eigen::Vector2d{left + u, v}, {grey, grey, grey});
      }
    }
  }
  void set(const Eigen::Vector2d& at, const Colour& colour) {
    const double u = std::round(at.x()), v = std::round(at.y());
    if (u < 0 || v < 0 || u >= width_ || v >= image_.height_()) return;
    const std::size_t place =
        static_cast<std::size_t>(v) * image_.step_() + 3 * static_cast<std::size_t>(u);
    std::ranges::copy(colour, image_.data_().begin() + static_cast<std::ptrdiff_t>(place));
  }

  int width_;
  msg::Image image_;
};

void draw_face(Sheet& sheet, const StereoCamera& camera, const scene::FacePoints& face,
               const Eigen::Vector3d& normal, const Colour& colour) {
  const Eigen::Vector2d right_picture{camera.width, 0};
  for (const bool left : {true, false}) {
    const auto seen = [&](const Eigen::Vector3d& p) -> Eigen::Vector2d {
      return left ? camera.project_left(p) : camera.project_right(p) + right_picture;
    };
    for (const Eigen::Vector3d& point : {face.left_eye, face.right_eye, face.mouth}) {
      if (point.z() > 0) sheet.cross(seen(point), colour);
    }
    const Eigen::Vector3d tip = face.mouth + kNormal_m * normal;
    if (face.mouth.z() > 0 && tip.z() > 0) sheet.line(seen(face.mouth), seen(tip), colour);
  }
}

}  // namespace

std::vector<std::size_t> worst_of(const std::vector<PairResult>& results, std::size_t count) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].pose) order.push_back(i);
  }
  std::ranges::stable_sort(order, std::greater{},
                           [&](std::size_t i) { return badness(results[i]); });
  order.resize(std::min(order.size(), count));
  return order;
}

void write_worst_pairs(const std::filesystem::path& folder,
                       const std::vector<PerceptionCase>& cases,
                       const std::vector<PairResult>& results) {
  Stage stage;
  jpeg::JpegEncoder encoder{kJpegQuality};
  std::vector<PairResult> worst;
  for (const std::size_t i : worst_of(results, kWorst)) {
    worst.push_back(results[i]);
    const FacePose& pose = *results[i].pose;
    const StagedPair pair = stage.take(cases[i]);
    Sheet sheet{pair};
    draw_face(sheet, cases[i].camera, pair.truth, pair.truth.normal(), kGreen);
    draw_face(sheet, cases[i].camera, {pose.left_eye, pose.right_eye, pose.mouth}, pose.normal,
              kRed);
    std::vector<std::uint8_t> jpeg;
    if (const auto done = encoder.encode(sheet.image(), jpeg); !done) {
      throw std::runtime_error(done.error().text);
    }
    write_atomically(folder / fmt::format("{:02}.jpg", worst.size()),
                     {reinterpret_cast<const char*>(jpeg.data()), jpeg.size()},
                     FileUse::named_by_user);
  }
  write_atomically(folder / "worst.csv", csv_of(worst), FileUse::named_by_user);
}

}  // namespace armature::bench
