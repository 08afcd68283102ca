# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Part of run.cmake. The project of docs/tutorials/port_a_kernel.md, which is examples/ported_kernel: its test passes,
# and the page shows its kernels as they are.
set(project "${SOURCE_DIR}/examples/ported_kernel")
set(build "${WORK_DIR}/ported_kernel")
set(page docs/tutorials/port_a_kernel.md)

configure("${project}" -B "${build}" "-DCMAKE_PREFIX_PATH=${prefix}" ${strict} ${without})
run("building ${build}" ${offline} "${CMAKE_COMMAND}" --build "${build}")
run("testing ${build}" "${CMAKE_CTEST_COMMAND}" --test-dir "${build}" --output-on-failure --no-tests=error)

foreach(kernel before after)
    file(READ "${project}/${kernel}.cu" text)
    string(REGEX REPLACE "^((//|#) SPDX[^\n]*\n)+" "" text "${text}")
    must_be_on_page("${kernel}.cu" "${text}")
    if(NVCC)
        foreach(architecture 80 90)
            run("compiling ${kernel}.cu" "${NVCC}" -std=c++20 -arch=sm_${architecture} "-I${prefix}/include"
                -c "${project}/${kernel}.cu" -o "${build}/${kernel}.o")
        endforeach()
    endif()
endforeach()
