# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Passes if strangers' projects can use the library, found as a package and included as a folder:
#   cmake -DSOURCE_DIR=. -DWORK_DIR=scratch -P run.cmake

foreach(variable SOURCE_DIR WORK_DIR)
    if(NOT ${variable})
        message(FATAL_ERROR "-D${variable}= is missing")
    endif()
    get_filename_component(${variable} "${${variable}}" ABSOLUTE)
endforeach()
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
    run("configuring ${source}" ${offline} "${CMAKE_COMMAND}" ${generator} -S "${source}" ${ARGN})
endfunction()

function(build_and_run dir)
    run("building ${dir}" ${offline} "${CMAKE_COMMAND}" --build "${dir}")
    run("running ${dir}/stranger" "${dir}/stranger")
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")

# Installed, and found.
configure("${SOURCE_DIR}" -B "${WORK_DIR}/warpagg" -DWARPAGG_EXAMPLES=OFF -DWARPAGG_TESTS=OFF ${without})
run("installing" "${CMAKE_COMMAND}" --install "${WORK_DIR}/warpagg" --prefix "${prefix}")
configure("${consumers_dir}/find_package" -B "${WORK_DIR}/find_package" "-DCMAKE_PREFIX_PATH=${prefix}"
    ${strict} ${without})
build_and_run("${WORK_DIR}/find_package")

# Another major version is refused.
file(WRITE "${WORK_DIR}/version_99/CMakeLists.txt"
    "cmake_minimum_required(VERSION 3.25)\nproject(stranger LANGUAGES CXX)\nfind_package(warpagg 99 REQUIRED)\n")
execute_process(
    COMMAND "${CMAKE_COMMAND}" ${generator} -S "${WORK_DIR}/version_99" -B "${WORK_DIR}/version_99/build"
        "-DCMAKE_PREFIX_PATH=${prefix}"
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(result EQUAL 0 OR NOT output MATCHES "requested[ \n]+version[ \n]+\"99\"")
    message(FATAL_ERROR "find_package(warpagg 99) is not refused for its version:\n${output}")
endif()

# Included as a folder: nothing is built but the stranger's own.
configure("${consumers_dir}/add_subdirectory" -B "${WORK_DIR}/add_subdirectory"
    "-DWARPAGG_SOURCE_DIR=${SOURCE_DIR}" ${strict} ${without})
build_and_run("${WORK_DIR}/add_subdirectory")
run("listing the targets" "${CMAKE_COMMAND}" --build "${WORK_DIR}/add_subdirectory" --target help)
foreach(ours gaussian_splatting test_library)
    if(output MATCHES "${ours}")
        message(FATAL_ERROR "add_subdirectory brings the target ${ours}:\n${output}")
    endif()
endforeach()
if(EXISTS "${WORK_DIR}/add_subdirectory/warpagg/examples" OR EXISTS "${WORK_DIR}/add_subdirectory/warpagg/tests")
    message(FATAL_ERROR "add_subdirectory configures examples or tests")
endif()
