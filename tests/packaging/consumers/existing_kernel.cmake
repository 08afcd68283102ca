# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Part of run.cmake. The project of docs/how-to/test_existing_kernels.md, which is examples/existing_kernel: its
# tests pass, and the page shows its files and its output as they are.
set(project "${SOURCE_DIR}/examples/existing_kernel")
set(build "${WORK_DIR}/existing_kernel")
set(page docs/how-to/test_existing_kernels.md)

configure("${project}" -B "${build}" "-DCMAKE_PREFIX_PATH=${prefix}" ${strict} ${without})
run("building ${build}" ${offline} "${CMAKE_COMMAND}" --build "${build}")
run("testing ${build}" "${CMAKE_CTEST_COMMAND}" --test-dir "${build}" --output-on-failure --no-tests=error)

foreach(file CMakeLists.txt scale.cu test_scale.cpp)
    file(READ "${project}/${file}" text)
    string(REGEX REPLACE "^((//|#) SPDX[^\n]*\n)+" "" text "${text}")
    must_be_on_page("${file}" "${text}")
endforeach()

run("running test_broken_scale" "${build}/test_broken_scale")
string(REPLACE "${project}/" "" output "${output}")
must_be_on_page("the output of test_broken_scale" "${output}")

if(NVCC)
    foreach(architecture 80 90)
        run("compiling scale.cu" "${NVCC}" -std=c++20 -arch=sm_${architecture} -c "${project}/scale.cu" -o "${build}/scale.o")
    endforeach()
endif()

# Without the option, the compiler names it.
execute_process(COMMAND "${CXX}" -std=c++20 -fsyntax-only "-I${prefix}/include" "${project}/test_scale.cpp"
    RESULT_VARIABLE result ERROR_VARIABLE output)
if(result EQUAL 0 OR NOT output MATCHES "error: [^\n]*warpagg/emulate_cuda.hpp needs -fsanitize=thread")
    message(FATAL_ERROR "Without -fsanitize=thread, the compiler says:\n${output}")
endif()
