// SPDX-License-Identifier: Apache-2.0
#include "armature/kinds/registration_dialogue.hpp"

#include "armature/messages/header.hpp"

namespace armature {

RegistrationDialogue::RegistrationDialogue(Output<msg::RegistrationRequest> requests,
                                           Input<msg::RegistrationResponse> answers,
                                           double marker_error, double match_tolerance)
    : marker_error_{marker_error},
      match_tolerance_{match_tolerance},
      requests_{requests},
      answers_{answers} {}

bool RegistrationDialogue::due(Time now) const {
  constexpr Duration kAnswerWithin = seconds(1.0);
  return asked_.none() || now - requested_at_ >= kAnswerWithin;
}

void RegistrationDialogue::ask(const Question& question, Time now) {
  requested_at_ = now;
  if (question != last_) forget();
  last_ = question;
  // A number that nobody else's question on this topic has, as far as one can tell.
  const auto id = static_cast<std::uint64_t>(now.ns);
  asked_.add(id);
  auto loan = requests_.loan();
  write_header(loan->header_(), now, question.robot_frame);
  loan->request_id_(id);
  loan->image_markers_() = question.image_markers;
  loan->robot_markers_() = question.robot_markers;
  loan->ordered_(false);
  loan->match_tolerance_(match_tolerance_);
  loan->marker_error_(question.marker_error > 0 ? question.marker_error : marker_error_);
  loan->targets_() = question.targets;
  loan.publish();
}

}  // namespace armature
