// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <armature_messages/builtin_interfaces.h>

#include "armature/messages/message_list.hpp"

ARMATURE_MESSAGES_BUILTIN_INTERFACES(ARMATURE_DECLARE_MESSAGE)
