# SPDX-FileCopyrightText: 2026 The warpagg authors
# SPDX-License-Identifier: MIT

# warpagg_embed(TARGET FILE VARIABLE): compiles the content of FILE into TARGET as
#     extern const std::string_view VARIABLE;
# in the namespace gs::embedded. FILE is relative to the current source folder. The build system
# writes the source again when FILE changes.
function(warpagg_embed target file variable)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded/${variable}.cpp)
    set(path ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
    file(READ ${path} bytes HEX)
    string(REGEX REPLACE "(..)" "'\\\\x\\1'," bytes "${bytes}")
    file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
#include <string_view>
namespace gs::embedded {
static constexpr char bytes[] = {@bytes@'\0'};
extern const std::string_view @variable@;
const std::string_view @variable@{bytes, sizeof bytes - 1};
}
]])
    set_property(SOURCE ${source} PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
    target_sources(${target} PRIVATE ${source})
endfunction()
