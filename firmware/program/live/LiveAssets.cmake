# SPDX-License-Identifier: Apache-2.0
# The web page's own files, in program_live; elements.js is the shop's page's, too.
millforce_embed_assets(program_live live/live_assets.hpp millforce::host::live_assets
    live_template ${CMAKE_CURRENT_LIST_DIR}/live_template.html
    live_style ${CMAKE_CURRENT_LIST_DIR}/live.css
    elements_script ${CMAKE_CURRENT_LIST_DIR}/elements.js
    live_script ${CMAKE_CURRENT_LIST_DIR}/live.js)
