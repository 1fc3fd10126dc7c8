# SPDX-License-Identifier: Apache-2.0
# Embeds what the pages are made of into their libraries, so that the program needs no file at run time: templates,
# styles and scripts, and the chart library dygraphs.

find_file(DYGRAPHS_SCRIPT dygraph.min.js PATHS /usr/share/javascript/dygraphs NO_DEFAULT_PATH)
find_file(DYGRAPHS_STYLE dygraph.min.css PATHS /usr/share/javascript/dygraphs NO_DEFAULT_PATH)
if(NOT DYGRAPHS_SCRIPT OR NOT DYGRAPHS_STYLE)
    message(FATAL_ERROR
        "dygraph.min.js or dygraph.min.css not found in /usr/share/javascript/dygraphs. Install the package "
        "libjs-dygraphs (Debian, Ubuntu), or set DYGRAPHS_SCRIPT and DYGRAPHS_STYLE to the two files.")
endif()

add_custom_target(embedded_assets)

# millforce_embed_assets(<target> <header> <namespace> <name> <file> …): functions of these names give the files' text
function(millforce_embed_assets target header namespace)
    set(assets ${ARGN})
    set(files ${ARGN})
    list(FILTER files INCLUDE REGEX "[.](html|css|js|toml)$")
    set(script ${PROJECT_SOURCE_DIR}/firmware/program/report/embed_assets.cmake)
    set(output ${CMAKE_CURRENT_BINARY_DIR}/assets/${target}.cpp)
    add_custom_command(
        OUTPUT ${output}
        COMMAND ${CMAKE_COMMAND} "-DASSETS=${assets}" -DHEADER=${header} -DNAMESPACE=${namespace} -DOUTPUT=${output}
                -P ${script}
        DEPENDS ${files} ${script}
        COMMENT "Embedding the templates, styles and scripts of ${target}"
        VERBATIM)
    target_sources(${target} PRIVATE ${output})
    add_custom_target(embedded_assets_of_${target} DEPENDS ${output})
    add_dependencies(embedded_assets embedded_assets_of_${target})
endfunction()

millforce_embed_assets(program_report report/page_assets.hpp millforce::host::page_assets
    report_style ${CMAKE_CURRENT_LIST_DIR}/report.css
    charts_script ${CMAKE_CURRENT_LIST_DIR}/charts.js
    dygraphs_script ${DYGRAPHS_SCRIPT}
    dygraphs_style ${DYGRAPHS_STYLE})
