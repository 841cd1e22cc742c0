// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <armature_messages/visualization_msgs.h>

#include "armature/messages/message_list.hpp"

ARMATURE_MESSAGES_VISUALIZATION_MSGS(ARMATURE_DECLARE_MESSAGE)
