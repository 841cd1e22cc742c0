// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "armature/task/procedure.hpp"
#include "armature/task/pursued_goal.hpp"

namespace armature ARMATURE_EXPORT {

/// Obeys an operator's word in a task that has the arm on its way to one goal: a pause stops the
/// arm, a resume lets it go on. What `back` and `abort` mean is the task's (both: nothing to
/// Expected<void>). Or why the word is refused: a confirmation and a resume while the arm is
/// stopped, too, since the goal would fail, and with it the task.
template <class Back, class Abort>
Expected<void> obey(const OperatorCommand& command, Procedure& procedure, PursuedGoal& goal,
                    const Back& back, const Abort& abort) {
  const bool lets_move = command.word == "confirm" || command.word == "resume";
  if (const auto may = goal.may_move(); !may && lets_move) return may;
  const auto word = procedure.hear(command);
  if (!word) return tl::unexpected{word.error()};
  switch (*word) {
    case OperatorWord::confirm: break;
    case OperatorWord::pause: goal.pause(); break;
    case OperatorWord::resume: goal.resume(); break;
    case OperatorWord::back: return back();
    case OperatorWord::abort: return abort();
  }
  return {};
}

}  // namespace armature
