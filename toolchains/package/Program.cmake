# SPDX-License-Identifier: Apache-2.0
# Beside the program, its units and rules (firmware/boards/linux): completion, settings of the service, examples.
set(component COMPONENT millforce)
set(examples ${CMAKE_INSTALL_DOCDIR}/examples)

install(FILES completions/millforce DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions ${component})
install(FILES completions/_millforce DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions ${component})
install(FILES tools.env logrotate.conf DESTINATION /etc/millforce ${component})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/sim/scenarios/ DESTINATION ${examples} ${component}
    FILES_MATCHING PATTERN *.toml PATTERN *.ngc PATTERN *.csv)
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} ${component})
install(FILES ${PROJECT_SOURCE_DIR}/drivers/millforce.dbc DESTINATION ${CMAKE_INSTALL_DATADIR}/millforce ${component})
