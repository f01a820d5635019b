# The files of the studio's page, for its server. The page's build leaves them in ${PROJECT_BINARY_DIR}/studio_page (target
# graftal_studio_page); without it a placeholder stands there.
if(NOT TARGET graftal_studio_page)
  set(placeholder ${PROJECT_SOURCE_DIR}/runtime/studio/server/placeholder.html)
  add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/studio_page/index.html VERBATIM DEPENDS ${placeholder}
    COMMAND ${CMAKE_COMMAND} -E copy ${placeholder} ${PROJECT_BINARY_DIR}/studio_page/index.html)
  add_custom_target(graftal_studio_page DEPENDS ${PROJECT_BINARY_DIR}/studio_page/index.html)
endif()

# Nobody knows the names of its files before the page is built. So this looks each time, and writes when they differ.
set(source ${PROJECT_BINARY_DIR}/studio_page_files.cpp)
add_custom_target(graftal_studio_files BYPRODUCTS ${source} VERBATIM
  COMMAND ${CMAKE_COMMAND} -DPAGE=${PROJECT_BINARY_DIR}/studio_page -DSOURCE=${source}
          -P ${PROJECT_SOURCE_DIR}/cmake/embed_page.cmake)
add_dependencies(graftal_studio_files graftal_studio_page)

target_sources(graftal_runtime_studio_server PRIVATE ${source})
set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
add_dependencies(graftal_runtime_studio_server graftal_studio_files)
# Beast is templates: its code waits for the network.
target_compile_options(graftal_runtime_studio_server PRIVATE $<$<CONFIG:Release>:-O1>)
