# What makes the installed program at home on a desktop: pages of the manual, completions, file types, a thumbnailer, editors.

set(documents ${PROJECT_BINARY_DIR}/documents)
add_custom_command(OUTPUT ${documents}/stamp
                   COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:graftal> -DFOLDER=${documents}
                           -P ${PROJECT_SOURCE_DIR}/cmake/documents.cmake
                   COMMAND ${CMAKE_COMMAND} -E touch ${documents}/stamp
                   DEPENDS graftal cmake/documents.cmake COMMENT "Printing the manual and the completions" VERBATIM)
add_custom_target(documents ALL DEPENDS ${documents}/stamp)

set(share ${CMAKE_INSTALL_DATADIR})
configure_file(share/metainfo.xml ${documents}/org.graftal.graftal.metainfo.xml @ONLY)
install(DIRECTORY ${documents}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(FILES share/graftal-thumbnailer.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${documents}/bash/graftal DESTINATION ${share}/bash-completion/completions COMPONENT program)
install(FILES ${documents}/fish/graftal.fish DESTINATION ${share}/fish/vendor_completions.d COMPONENT program)
install(FILES ${documents}/zsh/_graftal DESTINATION ${share}/zsh/vendor-completions COMPONENT program)
install(FILES share/graftal.desktop DESTINATION ${share}/applications COMPONENT program)
install(FILES share/graftal.mime.xml DESTINATION ${share}/mime/packages RENAME graftal.xml COMPONENT program)
install(FILES share/graftal.thumbnailer DESTINATION ${share}/thumbnailers COMPONENT program)
install(FILES ${documents}/org.graftal.graftal.metainfo.xml DESTINATION ${share}/metainfo COMPONENT program)
install(FILES share/graftal.svg DESTINATION ${share}/icons/hicolor/scalable/apps COMPONENT program)
install(PROGRAMS share/graftal-thumbnailer DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(FILES share/libgraftal1.lintian-overrides DESTINATION ${share}/lintian/overrides RENAME libgraftal1 COMPONENT library)
install(DIRECTORY share/vim/ DESTINATION ${share}/vim/vimfiles COMPONENT program)
install(FILES share/graftal.tmLanguage.json DESTINATION ${share}/graftal COMPONENT program)
