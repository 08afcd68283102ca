# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT
#
# Passes if SOURCE does not compile and the compiler prints the sentence of its first line:
#   cmake -DCOMPILER=g++ -DINCLUDE=include -DSOURCE=two_gates.cpp -P run.cmake
# -DOPTIONS=... replaces the option -fsyntax-only, which nvcc does not have.
# After "// expect: ", the sentence may be anywhere in the output. After "// expect only: ", it is the
# first error, and the output has at most 12 lines.

file(READ "${SOURCE}" text)
if(NOT text MATCHES "^// expect( only)?: ([^\n]+)\n")
  message(FATAL_ERROR "${SOURCE}: the first line is not '// expect: <sentence>'")
endif()
set(only "${CMAKE_MATCH_1}")
set(sentence "${CMAKE_MATCH_2}")

if(NOT DEFINED OPTIONS)
  set(OPTIONS -fsyntax-only)
endif()
set(ENV{LC_ALL} C)
execute_process(
  COMMAND "${COMPILER}" -std=c++20 ${OPTIONS} "-I${INCLUDE}" "${SOURCE}"
  RESULT_VARIABLE result
  OUTPUT_VARIABLE output
  ERROR_VARIABLE output)

if(result EQUAL 0)
  message(FATAL_ERROR "${SOURCE} compiles, but should not")
endif()
set(searched "${output}")
if(only)
  string(REGEX MATCH "error[^\n]*" searched "${output}")
  string(REGEX MATCHALL "\n" ends "${output}")
  list(LENGTH ends lines)
  if(lines GREATER 12)
    message(FATAL_ERROR "${SOURCE}: expected at most 12 lines, not the ${lines} of\n${output}")
  endif()
endif()
string(FIND "${searched}" "${sentence}" at)
if(at EQUAL -1)
  message(FATAL_ERROR "${SOURCE}: expected${only}\n  ${sentence}\namong\n${output}")
endif()
