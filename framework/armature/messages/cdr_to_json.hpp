// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "armature/messages/type_description.hpp"

namespace armature ARMATURE_EXPORT {

/// How arrays of bytes (images) are shown.
enum class OctetArrays { shortened, whole };

/// Any message as JSON, read by its description: fields in the order of the IDL, without trailing
/// underscores. More than 64 octets in one field become {"octets": n, "first": [...]} unless
/// `whole` is asked for. Refuses bytes that are no encoding of the type. Not real-time safe.
Expected<nlohmann::ordered_json> cdr_to_json(const TypeDescription& type,
                                             std::span<const std::byte> cdr,
                                             OctetArrays octets = OctetArrays::shortened);

}  // namespace armature
