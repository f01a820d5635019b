# The studio's session for a worker of a page: graftal_studio.js, which loads graftal_studio.wasm (emcc).
add_executable(studio_web runtime/studio/web/studio_web.cpp)
target_link_libraries(studio_web PRIVATE graftal_runtime_studio graftal_flags)
target_compile_definitions(studio_web PRIVATE GRAFTAL_VERSION="${PROJECT_VERSION}")
set(post ${PROJECT_SOURCE_DIR}/runtime/studio/web/post.js)
set_target_properties(studio_web PROPERTIES OUTPUT_NAME graftal_studio LINK_DEPENDS ${post})
target_link_options(studio_web PRIVATE --no-entry --js-library ${post} -sMODULARIZE=1 -sEXPORT_ES6=1 -sENVIRONMENT=worker
                    -sMAXIMUM_MEMORY=1GB -sFILESYSTEM=0 -sEXPORTED_FUNCTIONS=_malloc,_free)
