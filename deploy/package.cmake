# What is installed where, and the Debian package of it: cpack -G DEB in the build folder, once web/dist is built.
include(GNUInstallDirs)
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
install(FILES server/imaging/totalsegmentator.textproto DESTINATION ${CMAKE_INSTALL_DATADIR}/phrenic/labels)
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
install(DIRECTORY ${PROJECT_BINARY_DIR}/python/src/phrenic DESTINATION lib/python3/dist-packages
        PATTERN __pycache__ EXCLUDE)
install(DIRECTORY client/python/examples DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_CONTACT "The Phrenic developers <phrenic@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "The breathing diaphragm, simulated and streamed")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
    "A server that simulates the breathing diaphragm by a network of springs and rigid links, a viewer for
 browsers, and a command line. For research and teaching; not for clinical use.")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "ca-certificates, nginx, python3-grpcio, python3-numpy, python3-protobuf")
set(CPACK_DEBIAN_PACKAGE_PROVIDES "python3-phrenic")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
    "${PROJECT_SOURCE_DIR}/deploy/debian/postinst;${PROJECT_SOURCE_DIR}/deploy/debian/prerm;${PROJECT_SOURCE_DIR}/deploy/debian/postrm;${PROJECT_SOURCE_DIR}/deploy/debian/conffiles")
set(CPACK_STRIP_FILES ON)
include(CPack)
