# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Writes the reference, and fails if a public name is undocumented or a docstring is wrong:
#   cmake [-DOUTPUT_DIR=build/reference] [-DDOXYGEN=doxygen] -P docs/reference.cmake
get_filename_component(source_dir "${CMAKE_CURRENT_LIST_DIR}" DIRECTORY)
include("${source_dir}/cmake/version.cmake")
warpagg_version("${source_dir}/include" version)
if(NOT OUTPUT_DIR)
    set(OUTPUT_DIR "${source_dir}/build/reference")
endif()
if(NOT DOXYGEN)
    set(DOXYGEN doxygen)
endif()

file(MAKE_DIRECTORY "${OUTPUT_DIR}")
file(WRITE "${OUTPUT_DIR}/Doxyfile"
    "@INCLUDE = \"${source_dir}/docs/Doxyfile\"\nPROJECT_NUMBER = ${version}\nOUTPUT_DIRECTORY = \"${OUTPUT_DIR}\"\n")
execute_process(COMMAND "${DOXYGEN}" "${OUTPUT_DIR}/Doxyfile" WORKING_DIRECTORY "${source_dir}" RESULT_VARIABLE result)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "the reference has faults: see above")
endif()
message("${OUTPUT_DIR}/html/index.html")
