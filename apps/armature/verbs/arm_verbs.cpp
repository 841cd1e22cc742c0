// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "calculate/calculator.hpp"
#include "calculate/calibrate.hpp"
#include "calculate/calibrate_stereo.hpp"
#include "verbs/option_checks.hpp"
#include "verbs/verbs.hpp"
#include "workspace/workspace.hpp"

namespace armature {
namespace {

void add_calculators(CLI::App& app, Action& action) {
  auto arm = std::make_shared<ArmChoice>();
  auto solver = std::make_shared<SolverChoice>();
  auto input = std::make_shared<std::string>();

  CLI::App* fk = app.add_subcommand("fk", "Forward kinematics: JSON lines in, JSON lines out");
  add_arm(fk, *arm);
  fk->get_option("--robot")->required();
  fk->add_option("input", *input, "file of JSON lines (standard input)");
  fk->footer(
      "A line has all joints, in radians and metres:\n"
      "  echo '{\"joints\":[0,0,0,0,0,0]}' | armature fk --robot configs/robots/dental_lamp.yaml");
  fk->callback([=, &action] { action = [=] { return run_fk(*arm, *input); }; });

  CLI::App* ik = app.add_subcommand("ik", "Inverse kinematics: JSON lines in, JSON lines out");
  add_arm(ik, *arm);
  ik->get_option("--robot")->required();
  ik->add_option("--plugin", solver->plugin, "solver")->capture_default_str();
  ik->add_option("--params", solver->params, "its parameters, a YAML map: '{max_restarts: 3}'");
  ik->add_option("input", *input, "file of JSON lines (standard input)");
  ik->footer(
      "A line has position_m, and direction or quaternion_xyzw; it may have seed (joints),\n"
      "redundancy_rad or redundancy_m, tolerance_m, tolerance_rad and max_iterations:\n"
      "  echo '{\"position_m\":[1.3,0.321,0.504],\"direction\":[1,0,0]}' | armature ik --robot "
      "configs/robots/dental_lamp.yaml");
  ik->callback([=, &action] { action = [=] { return run_ik(*arm, *solver, *input); }; });
}

void add_workspace(CLI::App& app, Action& action) {
  auto options = std::make_shared<WorkspaceOptions>();
  CLI::App* workspace = app.add_subcommand(
      "workspace",
      "Where the tip of an arm comes to: armature workspace --robot configs/robots/med7_scope.yaml "
      "--incision 0.5115,-0.0634,0.2671 --plugin ik/srs_arm_angle --out workspace");
  add_arm(workspace, options->arm);
  workspace->get_option("--robot")->required();
  workspace
      ->add_option("--incision", options->incision_m,
                   "point of the base [m] that the shaft goes through: x,y,z; without, it is free")
      ->delimiter(',')
      ->expected(3);
  workspace->add_option("--min-depth", options->min_depth_mm, "of the tip in the incision [mm]")
      ->capture_default_str();
  workspace->add_option("--plugin", options->solver.plugin, "solver, with an incision")
      ->capture_default_str();
  workspace->add_option("--params", options->solver.params, "its parameters, a YAML map");
  add_ranged(workspace, "--samples", options->samples, "places, or joint positions, that are tried",
             1, 10'000'000);
  add_seed(workspace, options->seed, "of what is tried");
  workspace->add_option("--out", options->out, "folder for workspace.csv and workspace.svg")
      ->check(no_name);
  workspace->add_flag("--json", options->json, "as JSON");
  workspace->callback([=, &action] { action = [=] { return run_workspace(*options); }; });
}

void add_stereo_calibration(CLI::App* calibrate, Action& action) {
  auto options = std::make_shared<StereoCalibrationOptions>();
  CLI::App* stereo = calibrate->add_subcommand(
      "stereo",
      "Two cameras, from pictures of a chessboard: armature calibrate stereo --left pictures/left "
      "--right pictures/right --board 9 6 --square-mm 25 -o head.yaml");
  stereo->add_option("--left", options->left, "folder with the left camera's pictures")->required();
  stereo->add_option("--right", options->right, "folder with the right one's; may be the same")
      ->required();
  stereo
      ->add_option("--board", options->board, "inner corners along its rows, and along its columns")
      ->required()
      ->expected(2)
      ->allow_extra_args(false)
      ->check(CLI::Range(3, 50));
  stereo->add_option("--square-mm", options->square_mm, "side of a square, measured")
      ->required()
      ->check(wrong_number)
      ->check(CLI::Range(1.0, 500.0));
  stereo->add_option("-o,--output", options->output, "file for camera/stereo_pair to write")
      ->required();
  stereo->add_option("--rig", options->rig, "rig file to write, with the same cameras")
      ->check(no_name);
  stereo
      ->add_option("--coverage", options->coverage,
                   "picture (SVG) to write: where the corners were in the pictures")
      ->check(no_name);
  stereo->add_flag("--k3", options->with_k3, "of the distortion, too: for wide lenses");
  stereo->add_flag("--json", options->json, "as JSON");
  stereo->callback([=, &action] { action = [=] { return run_stereo_calibration(*options); }; });
}

void add_calibrations(CLI::App& app, Action& action) {
  CLI::App* calibrate = app.add_subcommand(
      "calibrate", "Where a tool, a tracker or two cameras are, from recorded poses or pictures");
  calibrate->require_subcommand(1);
  auto options = std::make_shared<CalibrationOptions>();
  const auto add = [&](const char* name, const char* what, int (*run)(const CalibrationOptions&)) {
    CLI::App* verb = calibrate->add_subcommand(name, what);
    verb->add_option("poses", options->poses, "file of recorded poses: JSON lines, or YAML")
        ->required();
    add_arm(verb, options->arm);
    verb->get_option("--tip")->description("frame that is the flange (flange)");
    verb->add_option("-o,--output", options->output, "YAML file to write (-, standard output)");
    verb->add_option("--tracker", options->tracker, "name of its frame")->capture_default_str();
    verb->add_option("--body", options->body, "name of its frame")->capture_default_str();
    verb->add_flag("--json", options->json, "as JSON");
    verb->callback([=, &action] { action = [=] { return run(*options); }; });
    return verb;
  };
  CLI::App* hand_eye = add("hand-eye",
                           "A tracker and a body on the flange: armature calibrate hand-eye "
                           "poses.jsonl --robot configs/robots/med7.yaml -o hand_eye.yaml",
                           run_hand_eye_calibration);
  hand_eye->add_option("--noise", options->noise, "of the tracker's poses, mm and deg per axis")
      ->expected(2)
      ->allow_extra_args(false);
  hand_eye->add_option("--at", options->at_m, "point of the base [m] whose error is told")
      ->expected(3)
      ->allow_extra_args(false);
  CLI::App* tool = add("tool",
                       "The tip of a tool that was turned about it: armature calibrate tool "
                       "poses.jsonl -o tool.yaml",
                       run_tool_calibration);
  tool->add_option("--tool", options->tool, "name of its frame")->capture_default_str();
  add_stereo_calibration(calibrate, action);
}

}  // namespace

void add_arm_verbs(CLI::App& app, Action& action) {
  add_calculators(app, action);
  add_workspace(app, action);
  add_calibrations(app, action);
}

}  // namespace armature
