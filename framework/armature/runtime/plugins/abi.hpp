// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bits/c++config.h>

// The ABI tag: what must be equal on both sides before a plugin may share objects with the
// framework. A plugin that does not come through the exported CMake targets lacks the Eigen
// settings, and its tag says so.

#define ARMATURE_ABI_TEXT2(x) #x
#define ARMATURE_ABI_TEXT(x) ARMATURE_ABI_TEXT2(x)

#define ARMATURE_FRAMEWORK_ABI 3

#ifdef EIGEN_MAX_ALIGN_BYTES
#define ARMATURE_ABI_EIGEN_ALIGN ARMATURE_ABI_TEXT(EIGEN_MAX_ALIGN_BYTES)
#else
#define ARMATURE_ABI_EIGEN_ALIGN "unset"
#endif
#ifdef EIGEN_MALLOC_ALREADY_ALIGNED
#define ARMATURE_ABI_EIGEN_MALLOC ARMATURE_ABI_TEXT(EIGEN_MALLOC_ALREADY_ALIGNED)
#else
#define ARMATURE_ABI_EIGEN_MALLOC "unset"
#endif

#define ARMATURE_ABI_TAG \
  "armature " ARMATURE_ABI_TEXT(ARMATURE_FRAMEWORK_ABI) ", compiler abi " ARMATURE_ABI_TEXT( \
      __GXX_ABI_VERSION) ", libstdc++ " ARMATURE_ABI_TEXT(_GLIBCXX_RELEASE)           \
      " cxx11 " ARMATURE_ABI_TEXT(_GLIBCXX_USE_CXX11_ABI) ", c++ " ARMATURE_ABI_TEXT( \
          __cplusplus) ", eigen align " ARMATURE_ABI_EIGEN_ALIGN                      \
                       " malloc " ARMATURE_ABI_EIGEN_MALLOC
