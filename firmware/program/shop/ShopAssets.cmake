# SPDX-License-Identifier: Apache-2.0
# The files of the shop's page, in program_shop.
millforce_embed_assets(program_shop shop/shop_assets.hpp millforce::host::shop_assets
    shop_page ${CMAKE_CURRENT_LIST_DIR}/shop.html
    shop_style ${CMAKE_CURRENT_LIST_DIR}/shop.css
    shop_script ${CMAKE_CURRENT_LIST_DIR}/shop.js)
