# SPDX-License-Identifier: Apache-2.0
# find_package(Armature) for plugin authors, from an installation or straight from a build folder.
include(CMakePackageConfigHelpers)

install(TARGETS armature_abi EXPORT ArmatureTargets)
install(EXPORT ArmatureTargets NAMESPACE Armature:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Armature)
export(EXPORT ArmatureTargets NAMESPACE Armature:: FILE "${CMAKE_BINARY_DIR}/ArmatureTargets.cmake")
file(COPY cmake/ArmaturePlugin.cmake cmake/plugin_manifest.cpp.in
              cmake/ArmatureKernel.cmake cmake/kernel.cpp.in DESTINATION "${CMAKE_BINARY_DIR}")
configure_package_config_file(cmake/ArmatureConfig.cmake.in "${CMAKE_BINARY_DIR}/ArmatureConfig.cmake"
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Armature)
write_basic_package_version_file("${CMAKE_BINARY_DIR}/ArmatureConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/ArmatureConfig.cmake" "${CMAKE_BINARY_DIR}/ArmatureConfigVersion.cmake"
              cmake/ArmaturePlugin.cmake cmake/plugin_manifest.cpp.in
              cmake/ArmatureKernel.cmake cmake/kernel.cpp.in
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Armature)
