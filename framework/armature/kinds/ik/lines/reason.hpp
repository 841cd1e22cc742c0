// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "armature/kinds/ik/ik.hpp"

namespace armature::ik_lines {

/// What `describe` says behind the name of the status, which a line tells apart.
std::string reason_of(const IkStatus& status);

/// The detail in such a reason: `reason_of` of a status with that detail is `reason` again. A
/// reason that says it otherwise is a detail as it stands.
std::string detail_in(std::string_view reason, IkStatus::Code code, double shortfall);

}  // namespace armature::ik_lines
