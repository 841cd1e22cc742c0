# SPDX-License-Identifier: Apache-2.0
# find_package(Armature) for plugin authors, from an installation or straight from a build folder.
include(CMakePackageConfigHelpers)
set(package_files cmake/ArmaturePlugin.cmake cmake/plugin_manifest.cpp.in cmake/ArmatureMessages.cmake)

install(EXPORT ArmatureTargets NAMESPACE Armature:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Armature)
export(EXPORT ArmatureTargets NAMESPACE Armature:: FILE "${Armature_BINARY_DIR}/ArmatureTargets.cmake")
file(COPY ${package_files} DESTINATION "${Armature_BINARY_DIR}")
configure_package_config_file(cmake/ArmatureConfig.cmake.in "${Armature_BINARY_DIR}/ArmatureConfig.cmake"
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Armature)
write_basic_package_version_file("${Armature_BINARY_DIR}/ArmatureConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${Armature_BINARY_DIR}/ArmatureConfig.cmake" "${Armature_BINARY_DIR}/ArmatureConfigVersion.cmake"
              ${package_files}
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Armature)
