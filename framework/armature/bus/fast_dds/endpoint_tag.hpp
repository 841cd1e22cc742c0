// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace armature ARMATURE_EXPORT {

/// What an endpoint of ours says of itself in its DDS user data:
/// "armature;deployment=dental_lamp;fingerprint=4f2a...;run=18a7...;layout=00c0ffee00c0ffee".
struct EndpointTag {
  bool ours = false;  // false: the endpoint belongs to some other program
  std::string deployment;
  std::string fingerprint;
  std::string run;
  std::uint64_t layout = 0;
};
/// Both belong to processes of one deployment, started together from one configuration.
inline bool same_deployment(const EndpointTag& a, const EndpointTag& b) {
  return a.ours && b.ours && a.fingerprint == b.fingerprint && a.run == b.run;
}

std::string to_user_data(const EndpointTag& tag);
/// Never fails: unknown keys are passed over, anything else is an endpoint that is not ours.
EndpointTag parse_endpoint_tag(std::span<const std::uint8_t> user_data);

}  // namespace armature
