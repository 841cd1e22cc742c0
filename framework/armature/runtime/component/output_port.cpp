// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component/output_port.hpp"

#include <fmt/format.h>

#include <utility>

#include "armature/runtime/component/ports.hpp"
#include "armature/runtime/plugins/setup_error.hpp"

namespace armature {

void OutputPort::refuse_or_drop() const {
  if (std::this_thread::get_id() != constructs_) return;
  throw SetupError(
      fmt::format("it publishes '{}' in its constructor, where nobody hears it; publish in the "
                  "first step",
                  spec_.name));
}

namespace detail {

SampleRef output_loan(OutputPort& port) { return port.topic().loan(); }
void output_prepare(OutputPort& port, const void* message) { port.topic().prepare(message); }
void output_publish(OutputPort& port, SampleRef sample) { port.publish(std::move(sample)); }

bool output_wanted(const OutputPort& port) { return port.has_subscribers(); }

}  // namespace detail
}  // namespace armature
