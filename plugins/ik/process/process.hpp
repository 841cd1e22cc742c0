// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "armature/kinds/ik/ik.hpp"
#include "armature/kinds/ik/lines/asking.hpp"
#include "ik_process_parameters.hpp"
#include "program.hpp"
#include "standard_error.hpp"

namespace armature::ik::process {

/// A solver in a program of its own, asked in the JSON lines of `armature ik`. What it answers is
/// worked out again by forward kinematics; a program that is dead, slow or makes no sense is ended,
/// and that is the reason why there is no solution.
///
/// Not real-time safe: `solve` waits for the program, one thread after the other. Details of a
/// status are kept for good; the 1025th different one is printed, and the detail says so.
class Process final : public IkSolver {
 public:
  /// Starts the program and asks it once, for the robot's resting position: refuses one that is not
  /// there, does not answer, or does not take that for a goal.
  static Expected<std::unique_ptr<IkSolver>> make(const RobotModel& model, const Params& params);

  IkStatus solve(const IkGoal& goal, const JointVector& seed, IkBranches& out,
                 IkState& state) const override;
  bool redundancy_is_length() const override {
    return parameters_.redundancy == Parameters::Redundancy::length;
  }

 private:
  Process(const RobotModel& model, Command command, const Parameters& parameters)
      : model_{&model},
        command_{std::move(command)},
        parameters_{parameters},
        errors_{"ik/process (" + command_.text() + ")"} {}

  Expected<ToldAnswer> ask(IkQuestion question) const;
  Expected<ToldAnswer> ask_once(IkQuestion question) const;
  std::string what_comes_next() const;
  IkStatus believed(const IkGoal& goal, const ToldAnswer& told, IkBranches& out) const;
  IkStatus refused(const std::string& what) const;
  std::string_view kept(const std::string& detail) const;

  const RobotModel* model_;
  Command command_;
  Parameters parameters_;

  // One question at a time.
  mutable std::mutex mutex_;
  mutable std::unique_ptr<Program> program_;  // none: to be started
  mutable bool has_answered_ = false;         // since it was started
  mutable std::int64_t questions_ = 0;
  mutable std::uint64_t failures_ = 0;  // in a row
  mutable std::string last_failure_;    // and what comes next
  mutable StandardError errors_;
};

}  // namespace armature::ik::process
