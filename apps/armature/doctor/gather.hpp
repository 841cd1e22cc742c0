// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "doctor/facts.hpp"

namespace armature::doctor {

/// Looks at this machine. To be called by a process with one thread: what may end the process, or
/// change how it runs, is tried by a child.
Facts facts_of_this_machine();

PluginFacts plugin_facts();

}  // namespace armature::doctor
