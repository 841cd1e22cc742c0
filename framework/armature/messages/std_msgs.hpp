// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <armature_messages/std_msgs.h>

#include "armature/messages/message_list.hpp"

ARMATURE_MESSAGES_STD_MSGS(ARMATURE_DECLARE_MESSAGE)
