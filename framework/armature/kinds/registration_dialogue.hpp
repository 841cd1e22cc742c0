// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "armature/messages/armature_msgs.hpp"
#include "armature/messages/geometry_msgs.hpp"
#include "armature/runtime/component/ports.hpp"
#include "armature/values/time.hpp"

namespace armature ARMATURE_EXPORT {

/// The numbers of the last questions: an answer may take longer than it takes to ask again.
class LastQuestions {
 public:
  void add(std::uint64_t id) {
    if (!has(id)) ids_[added_++ % ids_.size()] = id;
  }
  bool has(std::uint64_t id) const {
    return std::ranges::find(ids_, std::optional{id}) != ids_.end();
  }
  bool none() const { return added_ == 0; }

 private:
  std::array<std::optional<std::uint64_t>, 3> ids_;
  std::size_t added_ = 0;
};

/// How the markers of an image lie before a robot: a task's question to a registration, and the
/// answers to it.
class RegistrationDialogue {
 public:
  struct Question {
    std::string robot_frame;  // of robot_markers
    std::vector<msg::Point> image_markers, robot_markers, targets;
    double marker_error = 0;  // [m] that was told with the markers; 0: none, the parameter counts

    bool operator==(const Question&) const = default;
  };

  /// `marker_error` [m]: how well a marker is measured. `match_tolerance` [m]: how far two
  /// distances of the same markers may differ.
  RegistrationDialogue(Output<msg::RegistrationRequest> requests,
                       Input<msg::RegistrationResponse> answers, double marker_error,
                       double match_tolerance);

  /// True when it has not been asked yet, or not been answered in time.
  bool due(Time now) const;
  void ask(const Question& question, Time now);
  /// No answer to what was asked counts any more: what it asked of has changed.
  void forget() { asked_ = {}; }
  /// Calls `hear` with every answer to the question that was asked last, which may have been asked
  /// more than once; those to somebody else's are none.
  template <class Hear>
  void listen(const Hear& hear) const {
    for (std::size_t i = 0; i < answers_.size(); ++i) {
      if (asked_.has(answers_[i].request_id_())) hear(answers_[i]);
    }
  }

 private:
  double marker_error_, match_tolerance_;
  Question last_;
  LastQuestions asked_;  // that, some times
  Time requested_at_;
  Output<msg::RegistrationRequest> requests_;
  Input<msg::RegistrationResponse> answers_;
};

}  // namespace armature
