# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Part of run.cmake. The project of docs/tutorials/first_unit_test.md, which is examples/unit_testing: its tests pass, and the page
# shows its files and its output as they are.
set(project "${SOURCE_DIR}/examples/unit_testing")
set(build "${WORK_DIR}/unit_testing")
set(page docs/tutorials/first_unit_test.md)

configure("${project}" -B "${build}" "-DCMAKE_PREFIX_PATH=${prefix}" ${strict} ${without})
run("building ${build}" ${offline} "${CMAKE_COMMAND}" --build "${build}")
set(ENV{WARPAGG_SEED})
run("testing ${build}" "${CMAKE_CTEST_COMMAND}" --test-dir "${build}" --output-on-failure --no-tests=error)

foreach(file CMakeLists.txt moments.hpp moments.cu test_moments.cpp first_try.hpp)
    file(READ "${project}/${file}" text)
    string(REGEX REPLACE "^((//|#) SPDX[^\n]*\n)+" "" text "${text}")
    must_be_on_page("${file}" "${text}")
endforeach()

run("running test_first_try" "${build}/test_first_try")
string(REPLACE "${project}/" "" output "${output}")
must_be_on_page("the output of test_first_try" "${output}")

run("compiling test_moments without exceptions" "${CXX}" -std=c++20 -fno-exceptions -fno-rtti "-I${prefix}/include"
    "${project}/test_moments.cpp" -o "${build}/without_exceptions")
run("running test_moments without exceptions" "${build}/without_exceptions")
if(NVCC)
    run("compiling moments.cu" "${NVCC}" -std=c++20 -arch=sm_80 "-I${prefix}/include" -c "${project}/moments.cu"
        -o "${build}/moments.o")
endif()
