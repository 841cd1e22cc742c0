// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bits/c++config.h>

#include <cstddef>

#include "armature/values/header_tags.hpp"

// The ABI tag: what must be equal on both sides before a plugin may share objects with the
// framework. It says how both were compiled, and of each library that the plugin includes headers
// of, the tag of these headers (cmake/header_tags.cmake); those of Armature::abi are always among
// them. A plugin that does not come through the exported CMake targets lacks the Eigen settings,
// and its tag says so.

#define ARMATURE_ABI_TEXT2(x) #x
#define ARMATURE_ABI_TEXT(x) ARMATURE_ABI_TEXT2(x)

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
#ifdef _GLIBCXX_DEBUG  // containers have other members
#define ARMATURE_ABI_DEBUG "debug"
#else
#define ARMATURE_ABI_DEBUG "usual"
#endif
#if defined(__SANITIZE_ADDRESS__)
#define ARMATURE_ABI_SANITIZER "address"
#elif defined(__SANITIZE_THREAD__)
#define ARMATURE_ABI_SANITIZER "thread"
#else
#define ARMATURE_ABI_SANITIZER "none"
#endif

// Settings that give shared objects another layout, and that nobody needs, do not compile.
#ifdef EIGEN_DEFAULT_TO_ROW_MAJOR
#error "Armature's matrices are stored by columns: leave EIGEN_DEFAULT_TO_ROW_MAJOR out"
#endif
#ifdef EIGEN_DEFAULT_DENSE_INDEX_TYPE
static_assert(sizeof(EIGEN_DEFAULT_DENSE_INDEX_TYPE) == sizeof(std::ptrdiff_t),
              "Armature's matrices have sizes of std::ptrdiff_t: leave "
              "EIGEN_DEFAULT_DENSE_INDEX_TYPE out");
#endif
namespace armature::detail {
struct PaddedAsUsual {
  char first;
  double second;
};
static_assert(offsetof(PaddedAsUsual, second) == alignof(double),
              "Armature's structs are padded as usual: leave -fpack-struct out");
}  // namespace armature::detail

#define ARMATURE_ABI_TAG \
  "compiler abi " ARMATURE_ABI_TEXT(__GXX_ABI_VERSION) ", libstdc++ " ARMATURE_ABI_TEXT(           \
      _GLIBCXX_RELEASE) ", c++11 strings " ARMATURE_ABI_TEXT(_GLIBCXX_USE_CXX11_ABI)               \
      ", c++ " ARMATURE_ABI_TEXT(__cplusplus) ", containers " ARMATURE_ABI_DEBUG                   \
      ", sanitizer " ARMATURE_ABI_SANITIZER ", eigen align " ARMATURE_ABI_EIGEN_ALIGN              \
      ", eigen malloc " ARMATURE_ABI_EIGEN_MALLOC ", " ARMATURE_HEADERS_abi
