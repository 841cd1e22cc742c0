// SPDX-License-Identifier: Apache-2.0
#include "armature/runtime/component/output_port.hpp"

#include <utility>

#include "armature/runtime/component/ports.hpp"

namespace armature::detail {

SampleRef output_loan(OutputPort& port) { return port.topic().loan(); }
void output_prepare(OutputPort& port, const void* message) { port.topic().prepare(message); }
void output_publish(OutputPort& port, SampleRef sample) { port.publish(std::move(sample)); }

bool output_wanted(const OutputPort& port) { return port.has_subscribers(); }

}  // namespace armature::detail
