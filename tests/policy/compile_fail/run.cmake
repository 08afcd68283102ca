# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Passes if SOURCE does not compile and the compiler prints the sentence of its first line:
#   cmake -DCOMPILER=g++ -DINCLUDE=include -DSOURCE=two_gates.cpp -P run.cmake
# -DOPTIONS=... replaces the option -fsyntax-only, which nvcc does not have.
# After "// expect: ", the sentence may be anywhere in the output. After "// expect only: ", it is the
# only error, and the output has at most 12 lines. A line "// standard: c++17" replaces C++20.

file(READ "${SOURCE}" text)
if(NOT text MATCHES "^// expect( only)?: ([^\n]+)\n")
  message(FATAL_ERROR "${SOURCE}: the first line is not '// expect: <sentence>'")
endif()
set(only "${CMAKE_MATCH_1}")
set(sentence "${CMAKE_MATCH_2}")

set(standard c++20)
if(text MATCHES "\n// standard: ([^\n]+)\n")
  set(standard "${CMAKE_MATCH_1}")
endif()
if(NOT DEFINED OPTIONS)
  set(OPTIONS -fsyntax-only)
endif()
set(ENV{LC_ALL} C)
execute_process(
  COMMAND "${COMPILER}" -std=${standard} ${OPTIONS} "-I${INCLUDE}" "${SOURCE}"
  RESULT_VARIABLE result
  OUTPUT_VARIABLE output
  ERROR_VARIABLE output)

if(result EQUAL 0)
  message(FATAL_ERROR "${SOURCE} compiles, but should not")
endif()
string(FIND "${output}" "${sentence}" at)
if(at EQUAL -1)
  message(FATAL_ERROR "${SOURCE}: expected\n  ${sentence}\namong\n${output}")
endif()
if(only)
  string(REGEX MATCHALL "error:" errors "${output}")
  string(REGEX MATCHALL "\n" lines "${output}")
  list(LENGTH errors errors)
  list(LENGTH lines lines)
  if(errors GREATER 1 OR lines GREATER 12)
    message(FATAL_ERROR "${SOURCE}: expected one error in at most 12 lines, not ${errors} in ${lines}:\n${output}")
  endif()
endif()
