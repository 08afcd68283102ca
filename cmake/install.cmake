# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
# The headers; for find_package(warpagg) one target, the function warpagg_emulate_cuda, and a version that refuses
# another major; for pkg-config the include path.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/warpagg)
install(DIRECTORY include/warpagg DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT headers)
install(TARGETS warpagg EXPORT warpagg-targets INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT warpagg-targets NAMESPACE warpagg:: DESTINATION ${package_dir} COMPONENT headers)
install(FILES cmake/warpagg-config.cmake cmake/emulate_cuda.cmake DESTINATION ${package_dir}
    COMPONENT headers)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/warpagg-config-version.cmake
    COMPATIBILITY SameMajorVersion ARCH_INDEPENDENT)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/warpagg-config-version.cmake DESTINATION ${package_dir}
    COMPONENT headers)

# Relative to the file itself, so that the installed folder may be moved.
set(pkgconfig_dir ${CMAKE_INSTALL_DATADIR}/pkgconfig)
file(RELATIVE_PATH pkgconfig_to_include
    ${CMAKE_INSTALL_PREFIX}/${pkgconfig_dir} ${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR})
configure_file(cmake/warpagg.pc.in warpagg.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/warpagg.pc DESTINATION ${pkgconfig_dir} COMPONENT headers)
