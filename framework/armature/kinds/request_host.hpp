// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "armature/messages/header.hpp"
#include "armature/runtime/component/component.hpp"
#include "armature/runtime/component/setup.hpp"
#include "armature/values/expected.hpp"

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
      *response = Response{};  // it was used before
      response->header_() = requests_[i].header_();
      response->request_id_(requests_[i].request_id_());
      answer(requests_[i], *response);
      response.publish();
    }
  }

 protected:
  /// Fills an empty response, which has its header and its id.
  virtual void answer(const Request& request, Response& response) = 0;

  /// Of a response that is valid or has a reason: `write` fills in what was found.
  template <class Found, class Write>
  static void respond(const Expected<Found>& found, Response& response, const Write& write) {
    response.valid_(found.has_value());
    if (found) {
      write(*found);
    } else {
      response.reason_() = found.error().text;
    }
  }

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
