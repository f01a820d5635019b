# The page of `graftal studio`: runtime/studio/page, bundled by esbuild of npm into the folder studio_page. Its target is there where npm is installed; elsewhere the program has no page, and says so.
find_program(GRAFTAL_NPM npm DOC "npm, which brings what the page of graftal studio is built of; OFF: builds no page")
if(NOT GRAFTAL_NPM)
  message(STATUS "graftal studio will have no page: npm is not installed")
  return()
endif()

set(page_files index.html page.js page.css licences.html)
list(TRANSFORM page_files PREPEND ${CMAKE_BINARY_DIR}/studio_page/)
file(GLOB_RECURSE page_sources CONFIGURE_DEPENDS runtime/studio/page/*)
add_custom_command(OUTPUT ${page_files}
                   COMMAND ${PROJECT_SOURCE_DIR}/runtime/studio/page/build ${CMAKE_BINARY_DIR}/studio_page_work ${CMAKE_BINARY_DIR}/studio_page
                   DEPENDS ${page_sources} ${PROJECT_SOURCE_DIR}/share/graftal.tmLanguage.json ${PROJECT_SOURCE_DIR}/tools/setup.sh
                   COMMENT "Bundling the page of graftal studio" VERBATIM)
add_custom_target(graftal_studio_page ALL DEPENDS ${page_files})
