// SPDX-License-Identifier: Apache-2.0
// The one precompiled header of all tests.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "armature/kinds/ik/ik.hpp"
#include "armature/runtime/plugins/plugin_registry.hpp"
