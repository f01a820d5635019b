# find_package(graftal) gives graftal::graftal (docs/library.md).
include(${CMAKE_CURRENT_LIST_DIR}/graftalTargets.cmake)
