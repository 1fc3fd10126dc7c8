# Embeds what report.html is made of into the library sim_report, so that the program needs no file at run time:
# the template, style and scripts of this folder, and the chart library dygraphs.

find_file(DYGRAPHS_SCRIPT dygraph.min.js PATHS /usr/share/javascript/dygraphs NO_DEFAULT_PATH)
find_file(DYGRAPHS_STYLE dygraph.min.css PATHS /usr/share/javascript/dygraphs NO_DEFAULT_PATH)
if(NOT DYGRAPHS_SCRIPT OR NOT DYGRAPHS_STYLE)
    message(FATAL_ERROR
        "dygraph.min.js or dygraph.min.css not found in /usr/share/javascript/dygraphs. Install the package "
        "libjs-dygraphs (Debian, Ubuntu), or set DYGRAPHS_SCRIPT and DYGRAPHS_STYLE to the two files.")
endif()

set(REPORT_FOLDER ${CMAKE_CURRENT_SOURCE_DIR}/report)
set(REPORT_ASSETS
    report_template ${REPORT_FOLDER}/report_template.html
    report_style ${REPORT_FOLDER}/report.css
    charts_script ${REPORT_FOLDER}/charts.js
    top_view_script ${REPORT_FOLDER}/top_view.js
    report_script ${REPORT_FOLDER}/report.js
    dygraphs_script ${DYGRAPHS_SCRIPT}
    dygraphs_style ${DYGRAPHS_STYLE})
set(REPORT_ASSET_FILES ${REPORT_ASSETS})
list(FILTER REPORT_ASSET_FILES INCLUDE REGEX "[.](html|css|js)$")

set(REPORT_ASSETS_SOURCE ${CMAKE_CURRENT_BINARY_DIR}/report/report_assets.cpp)
add_custom_command(
    OUTPUT ${REPORT_ASSETS_SOURCE}
    COMMAND ${CMAKE_COMMAND} "-DASSETS=${REPORT_ASSETS}" -DOUTPUT=${REPORT_ASSETS_SOURCE}
            -P ${REPORT_FOLDER}/embed_assets.cmake
    DEPENDS ${REPORT_ASSET_FILES} ${REPORT_FOLDER}/embed_assets.cmake
    COMMENT "Embedding the report's template, style and scripts"
    VERBATIM)
target_sources(sim_report PRIVATE ${REPORT_ASSETS_SOURCE})
