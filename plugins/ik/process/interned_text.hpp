// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

// An answer points to its texts and does not own them; those of another program must be kept.
namespace armature::ik::process {

/// `label` in static storage; none when there are 256 different ones already, of which each may
/// have up to 100 bytes: then they do not name branches.
std::optional<std::string_view> lasting_label(std::string_view label);

/// `text`, cut at 500 bytes, in static storage; none when there are 1024 different ones already.
std::optional<std::string_view> lasting_detail(std::string_view text);

}  // namespace armature::ik::process
