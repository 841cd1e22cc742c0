// SPDX-License-Identifier: Apache-2.0
#include "bench/perception/perception_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "armature/values/angles.hpp"
#include "armature/values/json_text.hpp"
#include "bench/statistics.hpp"
#include "csv_field.hpp"

namespace armature::bench {
namespace {

constexpr const char* kAll = "all";

/// The row of the results that `counts` takes.
template <class Counts>
PerceptionRow row_of(const std::string& group, const std::vector<PairResult>& results,
                     const Counts& counts) {
  PerceptionRow row{.group = group};
  std::vector<double> normal, mouth, stereo_normal, stereo_mouth;
  for (const PairResult& result : results) {
    if (!counts(result)) continue;
    ++row.pairs;
    row.detected += result.detected;
    row.refused += result.detected && !result.pose;
    row.wrong += result.is_wrong();
    if (!result.pose) continue;
    normal.push_back(result.drawn.normal_rad);
    mouth.push_back(result.drawn.mouth_m);
    if (!result.stereo_only) continue;
    stereo_normal.push_back(result.stereo_only->normal_rad);
    stereo_mouth.push_back(result.stereo_only->mouth_m);
  }
  row.normal_rad = spread_of(normal);
  row.mouth_m = spread_of(mouth);
  row.stereo_only_normal_rad = spread_of(stereo_normal);
  row.stereo_only_mouth_m = spread_of(stereo_mouth);
  return row;
}

std::string text_of(const Spread& spread, double unit) {
  const auto number = [&](double value) {
    return std::isnan(value) ? fmt::format("{:>6}", "-") : fmt::format("{:>6.2f}", value / unit);
  };
  return fmt::format("{} {} {}", number(spread.median), number(spread.p95), number(spread.max));
}

nlohmann::ordered_json json_of(const Spread& spread) {
  const auto number = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
  };
  return {
      {"median", number(spread.median)}, {"p95", number(spread.p95)}, {"max", number(spread.max)}};
}

std::string number_or_nothing(const std::optional<double>& value) {
  return value ? fmt::format("{:.6g}", *value) : "";
}

}  // namespace

Spread spread_of(const std::vector<double>& values) {
  return {quantile(values, 0.5), quantile(values, 0.95), quantile(values, 1)};
}

std::vector<PerceptionRow> rows_of(const std::vector<PairResult>& results) {
  std::vector<PerceptionRow> rows;
  for (const PairResult& result : results) {
    if (!rows.empty() && rows.back().group == result.group) continue;
    rows.push_back(row_of(result.group, results,
                          [&](const PairResult& other) { return other.group == result.group; }));
  }
  rows.push_back(row_of(kAll, results, [](const PairResult&) { return true; }));
  return rows;
}

std::vector<StageRow> stages_of(const std::vector<PairResult>& results) {
  std::vector<double> full_pass;
  for (const PairResult& result : results) {
    if (result.times.full_pass) full_pass.push_back(*result.times.full_pass);
  }
  const double base = quantile(full_pass, 0.5);
  std::vector<StageRow> rows{
      {"detector, whole left picture", static_cast<int>(full_pass.size()), base, 1}};
  const auto add = [&](const std::string& stage, bool tracked, const auto& time_of) {
    std::vector<double> times;
    for (const PairResult& result : results) {
      if (result.is_tracked != tracked || !result.times.estimator) continue;
      times.push_back(time_of(result.times));
    }
    const double median = quantile(times, 0.5);
    rows.push_back({stage, static_cast<int>(times.size()), median, median / base});
  };
  for (const bool tracked : {false, true}) {
    const std::string which = tracked ? "tracked: " : "fresh: ";
    add(which + "detector, both pictures", tracked,
        [](const StageTimes& times) { return times.detector; });
    add(which + "landmarks, both pictures", tracked,
        [](const StageTimes& times) { return times.landmarks; });
    add(which + "face pose", tracked, [](const StageTimes& times) { return *times.estimator; });
  }
  return rows;
}

std::string table(const PerceptionReport& report) {
  std::size_t width = 6;
  for (const PerceptionRow& row : report.rows) width = std::max(width, row.group.size());
  std::string text =
      fmt::format("{:<{}}  {:>5}  {:>7}  {:>7}  {:>5}  {:^20}  {:^20}  {:^20}\n", "", width, "", "",
                  "", "WRONG", "normal [deg]", "mouth [mm]", "mouth, stereo only");
  text += fmt::format("{:<{}}  {:>5}  {:>7}  {:>7}  {:>5}", "cases", width, "pairs", "found",
                      "refused", "VALID");
  for (int i = 0; i < 3; ++i) text += fmt::format("  {:>6} {:>6} {:>6}", "median", "p95", "max");
  text += '\n';
  for (const PerceptionRow& row : report.rows) {
    text += fmt::format("{:<{}}  {:>5}  {:>5.0f} %  {:>7}  {:>5}  {}  {}  {}\n", row.group, width,
                        row.pairs, 100.0 * row.detected / std::max(row.pairs, 1), row.refused,
                        row.wrong, text_of(row.normal_rad, kRadPerDegree),
                        text_of(row.mouth_m, 1e-3), text_of(row.stereo_only_mouth_m, 1e-3));
  }
  text += fmt::format(
      "\n{}, {}, {} as {} has them, rig '{}', seed {}\n"
      "found: landmarks in both pictures; refused: of those by the estimator; errors of valid "
      "estimates against what was drawn,\nand against where the finder takes the same points to "
      "be in exact frontal pictures: stereo only\nWRONG VALID: the mouth is more than {:g} mm or "
      "the normal more than {:g} deg from what was drawn, and the estimate says that it is "
      "valid\n\n",
      report.detector, report.landmarks, report.face_pose, report.deployment, report.rig,
      report.seed, kMaxMouthError_m * 1e3, kMaxNormalError_rad / kRadPerDegree);
  text += fmt::format("{:<34}  {:>5}  {:>14}\n", "time, median", "pairs", "of a full pass");
  for (const StageRow& row : report.stages) {
    text +=
        fmt::format("{:<34}  {:>5}  {:>14}\n", row.stage, row.pairs,
                    std::isfinite(row.full_passes) ? fmt::format("{:.4f}", row.full_passes) : "-");
  }
  return text +
         "a full pass: the detector over the whole left picture of a fresh pair, in this run\n" +
         to_text(report.machine) + '\n';
}

std::string to_json(const PerceptionReport& report) {
  using Json = nlohmann::ordered_json;
  Json json{{"deployment", report.deployment},       {"rig", report.rig},
            {"detector", report.detector},           {"landmarks", report.landmarks},
            {"face_pose", report.face_pose},         {"seed", report.seed},
            {"max_mouth_error_m", kMaxMouthError_m}, {"max_normal_error_rad", kMaxNormalError_rad}};
  json["machine"] = to_json(report.machine);
  json["groups"] = Json::array();
  for (const PerceptionRow& row : report.rows) {
    json["groups"].push_back({{"group", row.group},
                              {"pairs", row.pairs},
                              {"found", row.detected},
                              {"refused", row.refused},
                              {"wrong_but_valid", row.wrong},
                              {"normal_rad", json_of(row.normal_rad)},
                              {"mouth_m", json_of(row.mouth_m)},
                              {"stereo_only_normal_rad", json_of(row.stereo_only_normal_rad)},
                              {"stereo_only_mouth_m", json_of(row.stereo_only_mouth_m)}});
  }
  json["stages"] = Json::array();
  for (const StageRow& row : report.stages) {
    Json line{{"stage", row.stage}, {"pairs", row.pairs}};
    if (std::isfinite(row.full_passes)) {
      line.update({{"median_s", row.median_s}, {"full_passes", row.full_passes}});
    }
    json["stages"].push_back(line);
  }
  return json_text(json);
}

std::string csv_of(const std::vector<PairResult>& results) {
  std::string csv =
      "group,number,face_seed,tracked,found,valid,wrong,mouth_m,normal_rad,stereo_only_mouth_m,"
      "stereo_only_normal_rad,full_pass_s,detector_s,landmarks_s,face_pose_s,reason\n";
  for (const PairResult& result : results) {
    const auto of_valid = [&](const std::optional<PoseError>& error, double PoseError::*part) {
      return result.pose && error ? fmt::format("{:.6g}", (*error).*part) : std::string{};
    };
    csv += fmt::format(
        "{},{},{},{:d},{:d},{:d},{:d},{},{},{},{},{},{:.6g},{:.6g},{},{}\n",
        csv_field(result.group), result.number, result.face_seed, result.is_tracked,
        result.detected, result.pose.has_value(), result.is_wrong(),
        of_valid(result.drawn, &PoseError::mouth_m), of_valid(result.drawn, &PoseError::normal_rad),
        of_valid(result.stereo_only, &PoseError::mouth_m),
        of_valid(result.stereo_only, &PoseError::normal_rad),
        number_or_nothing(result.times.full_pass), result.times.detector, result.times.landmarks,
        number_or_nothing(result.times.estimator), csv_field(result.reason));
  }
  return csv;
}

}  // namespace armature::bench
