// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <armature_messages/geometry_msgs.h>

#include "armature/messages/message_list.hpp"

ARMATURE_MESSAGES_GEOMETRY_MSGS(ARMATURE_DECLARE_MESSAGE)
