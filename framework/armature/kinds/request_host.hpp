// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"

namespace armature ARMATURE_EXPORT {

/// Runs a solver alone on the topics `request` and `response`: every request is answered once, in
/// order, under its own header and id; a bad one with a reason.
template <class Request, class Response>
class RequestHost : public Component {
 public:
  explicit RequestHost(Setup& setup)
      : Component{setup},
        requests_{setup.input<Request>("request")},
        responses_{setup.output<Response>("response")} {}

  void step(Time) final {
    for (std::size_t i = 0; i < requests_.size(); ++i) {
      auto response = responses_.loan();
      response->header_() = requests_[i].header_();
      response->request_id_(requests_[i].request_id_());
      answer(requests_[i], *response);
      response.publish();
    }
  }

 protected:
  /// Writes every field but the header and the id: the response is one that was used before.
  virtual void answer(const Request& request, Response& response) = 0;

  /// Poses are those of the base frame; a request that names none means that one.
  static std::optional<std::string> in_another_frame(const Request& request) {
    if (request.header_().frame_id_().empty()) return std::nullopt;
    return not_in_base(request.header_(), "the request");
  }

 private:
  Input<Request> requests_;
  Output<Response> responses_;
};

}  // namespace armature
