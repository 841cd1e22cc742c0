// SPDX-License-Identifier: Apache-2.0
// The program behind `armature calibrate stereo`, which gives it its options as one JSON object.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "armature/config/problems.hpp"
#include "armature/runtime/plugins/setup_error.hpp"
#include "armature/runtime/reporting/write_atomically.hpp"
#include "armature/values/json_text.hpp"
#include "board_pictures.hpp"
#include "rectification.hpp"
#include "written_calibration.hpp"

namespace armature {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kOk = 0, kFailed = 1, kInvalid = 3;  // as the command line's exit codes are
constexpr double kOutlier = 3;                     // times the median of a pair's residual
constexpr double kWellCovered = 0.7;
constexpr double kMaxRms = 2, kMaxRowError = 3;  // [px]; sound pictures leave some tenths
/// Cameras that stand still against each other leave as much as each of them does by itself.
constexpr double kMoreThanAlone = 2, kRounding_px = 0.05;

/// How far the rows of a corner's two rectified pixels are apart: rms and the worst [px].
struct RowErrors {
  double rms = 0, worst = 0;
};

RowErrors row_errors(const stereo::StereoCalibration& calibration,
                     const stereo::Rectification& made,
                     const std::vector<stereo::BoardView>& views) {
  const double left_max = calibration.left.max_radius(), right_max = calibration.right.max_radius();
  RowErrors errors;
  double squares = 0, count = 0;
  for (const stereo::BoardView& view : views) {
    for (std::size_t i = 0; i < view.left.size(); ++i) {
      const auto left = calibration.left.ray_of(view.left[i], left_max);
      const auto right = calibration.right.ray_of(view.right[i], right_max);
      if (!left || !right) {
        throw std::runtime_error(
            "nothing is written: a lens that fits the corners does not reach all of them; hold "
            "the board into the rims, too, or take k3 as well (--k3)");
      }
      const double off = made.camera.focal_px *
                         ((made.rectified_R_left * left->homogeneous()).hnormalized().y() -
                          (made.rectified_R_right * right->homogeneous()).hnormalized().y());
      squares += off * off;
      ++count;
      errors.worst = std::max(errors.worst, std::abs(off));
    }
  }
  errors.rms = std::sqrt(squares / std::max(count, 1.0));
  return errors;
}

/// Names the pairs that fit worse than the others.
std::vector<std::string> warn_of_outliers(const stereo::StereoFit& fit,
                                          const BoardPictures& pictures) {
  std::vector<double> sorted = fit.view_rms_px;
  std::ranges::sort(sorted);
  const double median = sorted[sorted.size() / 2];
  std::vector<std::string> outliers;
  for (std::size_t i = 0; i < fit.view_rms_px.size(); ++i) {
    if (fit.view_rms_px[i] <= kOutlier * median) continue;
    outliers.push_back(pictures.views[i].name);
    fmt::print(stderr,
               "{}: {:.3f} px remain, and {:.3f} px in the middle of all pairs; leave it out\n",
               outliers.back(), fit.view_rms_px[i], median);
  }
  return outliers;
}

void warn_of_coverage(const Json& told) {
  for (const char* side : {"left_coverage", "right_coverage"}) {
    if (told[side].get<double>() >= kWellCovered) continue;
    fmt::print(
        stderr,
        "{}: corners in {:.0f} % of the picture; hold the board into its rims and corners, too\n",
        side, 100 * told[side].get<double>());
  }
}

/// Warns where both cameras see the board stretched alike: nearly all sensors have pixels that are
/// as wide as high, and not all prints have such squares.
void warn_of_squares(const stereo::StereoCalibration& calibration) {
  constexpr double kPrinted = 0.003, kAlike = 0.5;
  const auto wider = [](const stereo::Lens& lens) { return lens.fx / lens.fy - 1; };
  const double left = wider(calibration.left), right = wider(calibration.right);
  const double less = std::min(std::abs(left), std::abs(right));
  if (less < kPrinted || std::abs(left - right) > kAlike * less) return;
  fmt::print(stderr,
             "fx is {:.4f} times fy of the left camera and {:.4f} times of the right one: are the "
             "board's squares as wide as high? measure both sides of the board, a print may be "
             "stretched; what is said of the errors holds for a board as it is stated\n",
             1 + left, 1 + right);
}

/// Throws for pictures that contradict each other: no pair of cameras sees them so.
[[noreturn]] void refuse_contradiction(const std::string& what,
                                       const std::vector<std::string>& outliers) {
  const std::string hint =
      outliers.empty() ? "no pair is worse than the others: was the board flat and still, are the "
                         "two pictures of a pair of one moment, and was no camera moved against "
                         "the other between the pairs?"
                       : fmt::format("leave out {}", fmt::join(outliers, ", "));
  throw std::runtime_error(fmt::format("nothing is written: {}; {}", what, hint));
}

double rounded(double value) { return std::stod(fmt::format("{:.4g}", value)); }

Json told(const BoardPictures& pictures, const stereo::StereoFit& fit,
          const stereo::Rectification& made) {
  const RowErrors rows = row_errors(fit.calibration, made, pictures.views);
  const auto cover = [&](auto side) {
    return rounded(coverage(pictures.views, side, pictures.width, pictures.height));
  };
  const Eigen::AngleAxisd turn{Eigen::Matrix3d{fit.calibration.right_T_left->linear()}};
  return {{"pairs", pictures.pairs},
          {"pairs_used", pictures.views.size()},
          {"left_residual_rms_px", rounded(fit.left_rms_px)},
          {"right_residual_rms_px", rounded(fit.right_rms_px)},
          {"row_error_rms_px", rounded(rows.rms)},
          {"row_error_max_px", rounded(rows.worst)},
          {"focal_px", std::round(1e3 * made.camera.focal_px) / 1e3},
          {"focal_sigma_px", rounded(fit.errors.focal_px)},
          {"centre_sigma_px", rounded(fit.errors.centre_px)},
          {"baseline_mm", std::round(1e6 * made.camera.baseline_m) / 1e3},
          {"baseline_sigma_mm", rounded(1e3 * fit.errors.baseline_m)},
          {"turned_deg", rounded(turn.angle() * 180 / std::numbers::pi)},
          {"turned_sigma_deg", rounded(fit.errors.rotation * 180 / std::numbers::pi)},
          {"left_coverage", cover(&stereo::BoardView::left)},
          {"right_coverage", cover(&stereo::BoardView::right)}};
}

std::vector<Eigen::Vector2d> corners_of(const chessboard::BoardShape& shape, double square_m) {
  std::vector<Eigen::Vector2d> corners;
  for (int row = 0; row < shape.rows; ++row) {
    for (int column = 0; column < shape.columns; ++column) {
      corners.emplace_back(square_m * column, square_m * row);
    }
  }
  return corners;
}

/// Throws where one file would be written over another, or over a write-protected one.
void check_outputs(const Json& options) {
  std::set<std::filesystem::path> files;
  for (const char* of : {"output", "rig", "coverage"}) {
    const std::string name = options[of];
    if (name.empty()) continue;
    const auto file = std::filesystem::weakly_canonical(std::filesystem::absolute(name));
    if (!files.insert(file).second) {
      throw SetupError(fmt::format("two of -o, --rig and --coverage name '{}'", name));
    }
    refuse_write_protected(name);
  }
}

int calibrate(const Json& options) {
  check_outputs(options);
  const chessboard::BoardShape shape{.columns = options["board"][0], .rows = options["board"][1]};
  const double square_m = 1e-3 * options["square_mm"].get<double>();
  const std::string output = options["output"], rig = options["rig"], cover = options["coverage"];
  const std::string mount = mount_text(rig);
  const BoardPictures pictures = read_board_pictures(options["left"].get<std::string>(),
                                                     options["right"].get<std::string>(), shape);
  const auto fit = stereo::fit_stereo(
      corners_of(shape, square_m), pictures.views,
      {.width = pictures.width, .height = pictures.height, .with_k3 = options["with_k3"]});
  if (!fit) throw std::runtime_error(fit.error().text);
  const std::vector<std::string> outliers = warn_of_outliers(*fit, pictures);
  if (std::max(fit->left_rms_px, fit->right_rms_px) > kMaxRms) {
    refuse_contradiction(fmt::format("{:.3f} px rms remain in the left pictures and {:.3f} px in "
                                     "the right ones, {} at most are taken",
                                     fit->left_rms_px, fit->right_rms_px, kMaxRms),
                         outliers);
  }
  const double together = std::hypot(fit->left_rms_px, fit->right_rms_px) / std::numbers::sqrt2;
  if (together > kMoreThanAlone * fit->alone_rms_px + kRounding_px) {
    refuse_contradiction(
        fmt::format("{:.3f} px rms remain of both cameras together, and {:.3f} px of each by "
                    "itself",
                    together, fit->alone_rms_px),
        outliers);
  }
  const auto made = stereo::rectification_of(fit->calibration);
  if (!made) throw std::runtime_error(made.error().text);
  const Json figures = told(pictures, *fit, *made);
  if (const double row = figures["row_error_max_px"]; row > kMaxRowError) {
    refuse_contradiction(
        fmt::format("rows are up to {} px apart, {} at most are taken", row, kMaxRowError),
        outliers);
  }
  warn_of_coverage(figures);
  warn_of_squares(fit->calibration);

  std::string comment =
      fmt::format("# armature calibrate stereo, a board of {} x {} corners, {:g} mm apart\n",
                  shape.columns, shape.rows, 1e3 * square_m);
  std::string table;
  for (const auto& [name, value] : figures.items()) {
    comment += fmt::format("#   {:<24}{}\n", name, json_text(value));
    table += fmt::format("  {:<24}{}\n", name, json_text(value));
  }
  write_atomically(output, opencv_text(fit->calibration, comment), FileUse::named_by_user);
  if (!rig.empty()) {
    write_atomically(rig, rig_text(made->camera, output, mount), FileUse::named_by_user);
  }
  if (!cover.empty()) {
    write_atomically(cover, coverage_svg(pictures.views, pictures.width, pictures.height),
                     FileUse::named_by_user);
  }
  fmt::print("{}", options["json"].get<bool>() ? json_text(figures, 1) + "\n" : table);
  return kOk;
}

int run(const char* options) {
  try {
    return calibrate(Json::parse(options));
  } catch (const SetupError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kInvalid;
  } catch (const config::ConfigError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kInvalid;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kFailed;
  }
}

}  // namespace
}  // namespace armature

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "this is a part of armature calibrate stereo\n");
    return 2;
  }
  return armature::run(argv[1]);
}
