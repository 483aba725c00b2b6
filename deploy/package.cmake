# What is installed where, and the Debian packages of it, phrenic and python3-phrenic: cpack -G DEB in the build folder,
# once web/dist is built.
include(GNUInstallDirs)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME programs)
set(PHRENIC_MADE ${PROJECT_BINARY_DIR}/package)

# The command line's own words: its manual and what completes it in three shells.
add_custom_command(
  OUTPUT ${PHRENIC_MADE}/phrenic.1 ${PHRENIC_MADE}/phrenic.bash ${PHRENIC_MADE}/_phrenic ${PHRENIC_MADE}/phrenic.fish
         ${PHRENIC_MADE}/phrenicd.1
  COMMAND ${CMAKE_COMMAND} -E make_directory ${PHRENIC_MADE}
  COMMAND phrenic man > ${PHRENIC_MADE}/phrenic.1
  COMMAND phrenic completion bash > ${PHRENIC_MADE}/phrenic.bash
  COMMAND phrenic completion zsh > ${PHRENIC_MADE}/_phrenic
  COMMAND phrenic completion fish > ${PHRENIC_MADE}/phrenic.fish
  COMMAND phrenicd man > ${PHRENIC_MADE}/phrenicd.1
  DEPENDS phrenic phrenicd VERBATIM)
add_custom_target(package_words ALL DEPENDS ${PHRENIC_MADE}/phrenic.1)

install(TARGETS phrenicd phrenic RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY server/scenes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/phrenic/scenes FILES_MATCHING PATTERN *.textproto)
install(DIRECTORY server/imaging/labels/ DESTINATION ${CMAKE_INSTALL_DATADIR}/phrenic/labels FILES_MATCHING PATTERN *.textproto)
install(DIRECTORY web/dist/ DESTINATION ${CMAKE_INSTALL_DATADIR}/phrenic/web)
install(FILES ${PHRENIC_MADE}/phrenic.1 ${PHRENIC_MADE}/phrenicd.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${PHRENIC_MADE}/phrenic.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME phrenic)
install(FILES ${PHRENIC_MADE}/_phrenic DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${PHRENIC_MADE}/phrenic.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
install(FILES deploy/phrenicd.service DESTINATION /lib/systemd/system)
install(FILES deploy/phrenicd.toml DESTINATION /etc/phrenic)
install(FILES deploy/nginx/guard.conf deploy/nginx/cluster.conf deploy/nginx/server.conf deploy/nginx/limits.conf
              deploy/nginx/listen.conf DESTINATION /etc/nginx/phrenic)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY client/examples/snakemake DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples)
install(DIRECTORY ${PROJECT_BINARY_DIR}/python/src/phrenic DESTINATION lib/python3/dist-packages COMPONENT python
        PATTERN __pycache__ EXCLUDE)
install(DIRECTORY client/python/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-phrenic COMPONENT python)
install(FILES client/python/README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-phrenic COMPONENT python)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "The Phrenic developers <phrenic@localhost>")
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL programs python)
set(CPACK_COMPONENT_PROGRAMS_DESCRIPTION
    "The breathing diaphragm, simulated and streamed
A server that simulates the breathing diaphragm by a network of springs and rigid links, a viewer for
browsers, and a command line. For research and teaching; not for clinical use.")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
    "The breathing diaphragm, simulated: for Python
Runs simulations on a server of Phrenic, or on one that it starts, and returns numpy arrays. For research
and teaching; not for clinical use.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_STRIP_FILES ON)

set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME phrenic)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_RECOMMENDS "ca-certificates, nginx, python3-phrenic")
set(control ${PROJECT_SOURCE_DIR}/deploy/debian)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_CONTROL_EXTRA
    "${control}/postinst;${control}/prerm;${control}/postrm;${control}/conffiles")

# Its compiled code is the decoder of frames. Useful without the programs of this machine, with a server elsewhere. Up to
# now its files were in phrenic.
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-phrenic)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.9), python3-grpcio, python3-numpy, python3-protobuf")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "phrenic (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib, python3-pandas, python3-scipy, python3-xarray")
set(CPACK_DEBIAN_PYTHON_PACKAGE_REPLACES phrenic)
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${control}/python/prerm")
include(CPack)
