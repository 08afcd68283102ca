# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT

# The version that the headers in `include` say they have, as 1.2.3.
function(warpagg_version include result)
    set(version "")
    file(READ "${include}/warpagg/version.hpp" text)
    foreach(part MAJOR MINOR PATCH)
        if(NOT text MATCHES "#define WARPAGG_VERSION_${part} ([0-9]+)\n")
            message(FATAL_ERROR "${include}/warpagg/version.hpp has no WARPAGG_VERSION_${part}")
        endif()
        list(APPEND version ${CMAKE_MATCH_1})
    endforeach()
    list(JOIN version . version)
    set(${result} ${version} PARENT_SCOPE)
endfunction()
