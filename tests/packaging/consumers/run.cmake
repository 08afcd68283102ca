# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Passes if strangers' projects can use the library: found as a package by CMake or pkg-config, included as a
# folder, or fetched; and, where NVCC is given, in CUDA:
#   cmake -DSOURCE_DIR=. -DWORK_DIR=scratch [-DCXX=g++] [-DNVCC=nvcc] -P run.cmake

foreach(variable SOURCE_DIR WORK_DIR)
    if(NOT ${variable})
        message(FATAL_ERROR "-D${variable}= is missing")
    endif()
    get_filename_component(${variable} "${${variable}}" ABSOLUTE)
endforeach()
if(NOT CXX)
    set(CXX c++)
endif()
include("${SOURCE_DIR}/cmake/version.cmake")
set(consumers_dir "${CMAKE_CURRENT_LIST_DIR}")
set(prefix "${WORK_DIR}/prefix")

find_program(ninja NAMES ninja ninja-build)
set(generator "")
if(ninja)
    set(generator -G Ninja)
endif()

# A namespace without a network, where the system lets us have one; else proxies that lead nowhere.
set(offline "${CMAKE_COMMAND}" -E env http_proxy=http://127.0.0.1:9 https_proxy=http://127.0.0.1:9
    GIT_ALLOW_PROTOCOL=none)
find_program(unshare unshare)
if(unshare)
    execute_process(COMMAND "${unshare}" --net --map-root-user true RESULT_VARIABLE result ERROR_QUIET)
    if(result EQUAL 0)
        set(offline "${unshare}" --net --map-root-user)
    endif()
endif()

# What a stranger need not have: a search for one of them that is required fails.
set(without "")
foreach(package CUDAToolkit doctest glm JPEG nlohmann_json OpenMP PNG Threads)
    list(APPEND without -DCMAKE_DISABLE_FIND_PACKAGE_${package}=TRUE)
endforeach()
set(strict "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wpedantic -Werror")

function(run what)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${what} fails:\n${output}")
    endif()
    set(output "${output}" PARENT_SCOPE)
endfunction()

function(configure source)
    run("configuring ${source}" ${offline} "${CMAKE_COMMAND}" ${generator} -S "${source}"
        "-DCMAKE_CXX_COMPILER=${CXX}" ${ARGN})
endfunction()

function(build_and_run dir)
    run("building ${dir}" ${offline} "${CMAKE_COMMAND}" --build "${dir}")
    run("running ${dir}/stranger" "${dir}/stranger")
endfunction()

# Fails unless ${page}, a page of the documentation, shows this text.
function(must_be_on_page what text)
    file(READ "${SOURCE_DIR}/${page}" shown)
    string(FIND "${shown}" "${text}" at)
    if(at EQUAL -1)
        message(FATAL_ERROR "${page} does not show ${what} as it is:\n${text}")
    endif()
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")

# Installed, and found.
configure("${SOURCE_DIR}" -B "${WORK_DIR}/warpagg" -DWARPAGG_EXAMPLES=OFF -DWARPAGG_TESTS=OFF ${without})
run("installing" "${CMAKE_COMMAND}" --install "${WORK_DIR}/warpagg" --prefix "${prefix}")
configure("${consumers_dir}/find_package" -B "${WORK_DIR}/find_package" "-DCMAKE_PREFIX_PATH=${prefix}"
    ${strict} ${without})
build_and_run("${WORK_DIR}/find_package")
configure("${consumers_dir}/old_names" -B "${WORK_DIR}/old_names" "-DCMAKE_PREFIX_PATH=${prefix}"
    ${strict} ${without})
build_and_run("${WORK_DIR}/old_names")
include("${consumers_dir}/unit_testing.cmake")
include("${consumers_dir}/existing_kernel.cmake")
include("${consumers_dir}/ported_kernel.cmake")

# The one version number is everywhere the same, and another major version is refused.
warpagg_version("${prefix}/include" version)
function(find_version requested)
    set(source "${WORK_DIR}/version ${requested}")
    file(WRITE "${source}/CMakeLists.txt"
        "cmake_minimum_required(VERSION 3.25)\nproject(stranger LANGUAGES CXX)\n"
        "find_package(warpagg ${requested} REQUIRED)\n")
    execute_process(
        COMMAND "${CMAKE_COMMAND}" ${generator} -S "${source}" -B "${source}/build"
            "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_PREFIX_PATH=${prefix}"
        RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    set(result ${result} PARENT_SCOPE)
    set(output "${output}" PARENT_SCOPE)
endfunction()
find_version("${version} EXACT")
if(NOT result EQUAL 0)
    message(FATAL_ERROR "find_package(warpagg ${version} EXACT) fails:\n${output}")
endif()
find_version(99)
if(result EQUAL 0 OR NOT output MATCHES "requested[ \n]+version[ \n]+\"99\"")
    message(FATAL_ERROR "find_package(warpagg 99) is not refused for its version:\n${output}")
endif()
file(STRINGS "${SOURCE_DIR}/CHANGELOG.md" newest REGEX "^## \\[[0-9]" LIMIT_COUNT 1)
if(NOT newest MATCHES "^## \\[${version}\\]")
    message(FATAL_ERROR "CHANGELOG.md's newest version is '${newest}', but the headers say ${version}")
endif()

# By pkg-config, after the installed folder has been moved.
find_program(pkg_config NAMES pkgconf pkg-config)
if(pkg_config)
    set(moved "${WORK_DIR}/moved")
    file(COPY "${prefix}/" DESTINATION "${moved}")
    set(ENV{PKG_CONFIG_PATH} "${moved}/share/pkgconfig")
    run("pkg-config --modversion" "${pkg_config}" --modversion warpagg)
    if(NOT output STREQUAL "${version}\n")
        message(FATAL_ERROR "pkg-config says version ${output}, the headers ${version}")
    endif()
    run("pkg-config --cflags" "${pkg_config}" --cflags warpagg)
    separate_arguments(cflags UNIX_COMMAND "${output}")
    run("compiling by pkg-config" "${CXX}" -std=c++20 ${cflags}
        "${consumers_dir}/stranger.cpp" -o "${moved}/stranger")
    run("running ${moved}/stranger" "${moved}/stranger")
else()
    message("skipped: the consumer by pkg-config, as there is no pkg-config")
endif()

# Included as a folder or fetched: nothing is built and nothing is installed but the stranger's own, unless asked.
foreach(way add_subdirectory fetch_content)
    set(build "${WORK_DIR}/${way}")
    configure("${consumers_dir}/${way}" -B "${build}" "-DWARPAGG_SOURCE_DIR=${SOURCE_DIR}" ${strict} ${without})
    build_and_run("${build}")
    run("listing the targets" "${CMAKE_COMMAND}" --build "${build}" --target help)
    foreach(ours gaussian_splatting test_policy)
        if(output MATCHES "${ours}")
            message(FATAL_ERROR "${way} brings the target ${ours}:\n${output}")
        endif()
    endforeach()
    file(GLOB_RECURSE theirs "${build}/*/examples/CTestTestfile.cmake" "${build}/*/tests/CTestTestfile.cmake"
        "${build}/*/examples/cmake_install.cmake" "${build}/*/tests/cmake_install.cmake")
    if(theirs)
        message(FATAL_ERROR "${way} configures examples or tests: ${theirs}")
    endif()
    foreach(asked OFF ON)
        if(asked)
            configure("${consumers_dir}/${way}" -B "${build}" -DWARPAGG_INSTALL=ON)
        endif()
        set(into "${build}/installed ${asked}")
        run("installing ${way}" "${CMAKE_COMMAND}" --install "${build}" --prefix "${into}")
        if((EXISTS "${into}/include/warpagg/atomic.hpp" AND NOT asked)
            OR (asked AND NOT EXISTS "${into}/include/warpagg/atomic.hpp"))
            message(FATAL_ERROR "${way} with WARPAGG_INSTALL ${asked}: wrong files in ${into}")
        endif()
    endforeach()
endforeach()

# In CUDA. It is compiled; whether it runs depends on a GPU.
if(NVCC)
    set(build "${WORK_DIR}/cuda")
    configure("${consumers_dir}/cuda" -B "${build}" "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CUDA_COMPILER=${NVCC}"
        -DCMAKE_CUDA_ARCHITECTURES=80)
    run("building ${build}" ${offline} "${CMAKE_COMMAND}" --build "${build}")
    execute_process(COMMAND "${build}/stranger" RESULT_VARIABLE result OUTPUT_VARIABLE output)
    if(NOT result EQUAL 0 AND NOT result EQUAL 77)
        message(FATAL_ERROR "running ${build}/stranger fails:\n${output}")
    endif()
    message("consumer in CUDA: ${output}")
else()
    message("skipped: the consumer in CUDA, as there is no nvcc")
endif()
