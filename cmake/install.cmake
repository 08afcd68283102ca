# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
# find_package(warpagg): the headers, one target, and a version that refuses another major.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/warpagg)
install(DIRECTORY include/warpagg DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS warpagg EXPORT warpagg-targets)
install(EXPORT warpagg-targets NAMESPACE warpagg:: FILE warpagg-config.cmake DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/warpagg-config-version.cmake
    COMPATIBILITY SameMajorVersion ARCH_INDEPENDENT)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/warpagg-config-version.cmake DESTINATION ${package_dir})
