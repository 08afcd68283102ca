# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
# How this project builds its own examples and tests. Nothing here affects projects that include the library.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

if(WARPAGG_CUDA STREQUAL "AUTO" OR WARPAGG_CUDA)
    include(CheckLanguage)
    if(NOT CMAKE_CUDA_COMPILER)
        find_program(WARPAGG_NVCC nvcc HINTS /usr/local/cuda/bin)
        if(WARPAGG_NVCC)
            set(CMAKE_CUDA_COMPILER ${WARPAGG_NVCC})
        endif()
    endif()
    check_language(CUDA)
endif()
if(NOT WARPAGG_CUDA OR NOT CMAKE_CUDA_COMPILER)
    if(WARPAGG_CUDA AND NOT WARPAGG_CUDA STREQUAL "AUTO")
        message(FATAL_ERROR "WARPAGG_CUDA=ON, but no nvcc was found: put it on PATH or set CMAKE_CUDA_COMPILER")
    endif()
    set(warpagg_with_cuda OFF)
else()
    set(warpagg_with_cuda ON)
    if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
        set(CMAKE_CUDA_ARCHITECTURES 80 90)
    endif()
    enable_language(CUDA)
    if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)  # CMake 3.25 does not know that nvcc can do C++20
        set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
    endif()
    find_package(CUDAToolkit REQUIRED)
endif()
message(STATUS "warpagg: CUDA ${warpagg_with_cuda}")

# Options of everything that is built here; `warpagg_build` adds those for a CPU.
add_library(warpagg_options INTERFACE)
target_link_libraries(warpagg_options INTERFACE warpagg::warpagg)
target_compile_options(warpagg_options INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wpedantic -Wconversion -Wshadow>
    $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<BOOL:${WARPAGG_WERROR}>>:-Werror>
    # GCC 12 reports overlaps in std::string's operator+ that cannot occur (its bug 105651).
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-restrict>
    # GCC compiles faster if it collects garbage only above a gigabyte.
    "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:SHELL:--param ggc-min-expand=300 --param ggc-min-heapsize=1048576>"
    # Tests compare bits, so only an explicit fma may contract.
    $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>
    # Warning 20012 is about GLM's defaulted constructors.
    $<$<COMPILE_LANGUAGE:CUDA>:-diag-suppress=20012 -Xcompiler=-Wall,-Wextra>)
add_library(warpagg_build INTERFACE)
target_link_libraries(warpagg_build INTERFACE warpagg_options)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    target_compile_options(warpagg_build INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-march=${WARPAGG_CPU_ARCH}>)
endif()
if(WARPAGG_SANITIZE)
    target_compile_options(warpagg_options INTERFACE
        $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${WARPAGG_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer>)
    target_link_options(warpagg_options INTERFACE -fsanitize=${WARPAGG_SANITIZE})
endif()
