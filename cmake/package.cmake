# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Debian packages, which `cpack` writes: the component `headers` is libwarpagg-dev, and `trainer` is
# warpagg-gaussian-splatting.
find_program(WARPAGG_GZIP gzip)
if(NOT WARPAGG_GZIP)
    return()  # no Debian
endif()
set(headers_package libwarpagg-dev)
set(trainer_package warpagg-gaussian-splatting)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "The warpagg authors <packages@warpagg.invalid>" CACHE STRING
    "Name and mail address of the packages' maintainer")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # CPack would put it before those of the components
set(CPACK_COMPONENTS_ALL headers)

set(CPACK_DEBIAN_HEADERS_PACKAGE_NAME ${headers_package})
set(CPACK_DEBIAN_HEADERS_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_HEADERS_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_HEADERS_DESCRIPTION "Warp-aggregated atomics for CUDA and CPUs
Header-only C++20 library. The lanes of a warp combine their values before
they access memory. An emulator runs the same kernels on a CPU.")

if(TARGET gaussian_splatting)
    list(APPEND CPACK_COMPONENTS_ALL trainer)
    set(CPACK_DEBIAN_TRAINER_PACKAGE_NAME ${trainer_package})
    set(CPACK_DEBIAN_TRAINER_PACKAGE_SECTION graphics)
    set(CPACK_DEBIAN_TRAINER_PACKAGE_SHLIBDEPS ON)
    set(CPACK_DEBIAN_TRAINER_PACKAGE_RECOMMENDS "colmap, ffmpeg")
    set(CPACK_COMPONENT_TRAINER_DESCRIPTION "Trainer of 3D Gaussian splatting models from photos
Fits 3D Gaussians to photos, and writes .ply and .splat files. Without a GPU
that it can use, it computes on the CPU.")
endif()

# The files that Debian's policy requires. Only packages contain them.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(packaging/debian/changelog.in changelog @ONLY)
execute_process(COMMAND ${WARPAGG_GZIP} -9nkf ${PROJECT_BINARY_DIR}/changelog COMMAND_ERROR_IS_FATAL ANY)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
    set(folder ${CMAKE_INSTALL_DATADIR}/doc/${${component}_package})
    install(FILES packaging/debian/copyright ${PROJECT_BINARY_DIR}/changelog.gz README.md
        DESTINATION ${folder} COMPONENT ${component} EXCLUDE_FROM_ALL)
    install(DIRECTORY docs DESTINATION ${folder} COMPONENT ${component} EXCLUDE_FROM_ALL
        FILES_MATCHING PATTERN contributing EXCLUDE PATTERN *.md PATTERN *.png)
endforeach()
include(CPack)
