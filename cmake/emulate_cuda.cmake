# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT

# warpagg_emulate_cuda(TARGET SOURCE...): lets these sources of a test program include
# <warpagg/emulate_cuda.hpp> and CUDA kernels. It compiles them with -fsanitize=thread, which reports the
# kernels' memory accesses, and without optimization, which would remove some. It adds the emulator to the
# target, which replaces the sanitizers' libraries. Call it in the folder that adds the target.
function(warpagg_emulate_cuda target)
    if(NOT CMAKE_CXX_COMPILER_ID MATCHES "^(GNU|Clang)$")
        message(FATAL_ERROR "warpagg_emulate_cuda needs GCC or clang")
    endif()
    set(options -O0 -g -fsanitize=thread -Wno-unknown-pragmas)  # as "#pragma unroll"
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        list(APPEND options -fsanitize=bounds)
    else()
        # Clang would not report a read that a write to the same address follows.
        list(APPEND options -fsanitize=array-bounds -mllvm -tsan-instrument-read-before-write=1)
    endif()
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS ${options})
    set_property(SOURCE ${ARGN} PROPERTY SKIP_PRECOMPILE_HEADERS ON)

    set(runtime ${CMAKE_CURRENT_BINARY_DIR}/${target}_emulate_cuda_runtime.cpp)
    file(CONFIGURE OUTPUT ${runtime} CONTENT "#include <warpagg/emulate_cuda/runtime.hpp>\n")
    target_sources(${target} PRIVATE ${runtime})
    target_link_libraries(${target} PRIVATE warpagg::warpagg ${CMAKE_DL_LIBS})
    target_link_options(${target} PRIVATE LINKER:--wrap=memcpy,--wrap=memmove,--wrap=memset)

    # Where kernels find <cuda_runtime.h> and <cooperative_groups.h>.
    get_target_property(include_dirs warpagg::warpagg INTERFACE_INCLUDE_DIRECTORIES)
    foreach(dir IN LISTS include_dirs)
        target_include_directories(${target} BEFORE PRIVATE ${dir}/warpagg/emulate_cuda/cuda_headers)
    endforeach()
endfunction()
