# SPDX-License-Identifier: Apache-2.0
# The target `header_only_packages`: fmt and toml++ for another processor, whose headers hold all of them, out of this
# machine's packages. Links to the two folders keep the machine's other headers out of sight.
find_path(MILLFORCE_HOST_HEADERS NAMES fmt/format.h REQUIRED NO_CMAKE_FIND_ROOT_PATH)
find_path(MILLFORCE_HOST_TOML_HEADERS NAMES toml++/toml.h REQUIRED NO_CMAKE_FIND_ROOT_PATH)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/header_only)
file(CREATE_LINK ${MILLFORCE_HOST_HEADERS}/fmt ${PROJECT_BINARY_DIR}/header_only/fmt SYMBOLIC)
file(CREATE_LINK ${MILLFORCE_HOST_TOML_HEADERS}/toml++ ${PROJECT_BINARY_DIR}/header_only/toml++ SYMBOLIC)

add_library(header_only_packages INTERFACE)
target_compile_definitions(header_only_packages INTERFACE FMT_HEADER_ONLY=1 TOML_HEADER_ONLY=1)
target_include_directories(header_only_packages SYSTEM INTERFACE ${PROJECT_BINARY_DIR}/header_only)
target_link_libraries(header_only_packages INTERFACE Eigen3::Eigen)
