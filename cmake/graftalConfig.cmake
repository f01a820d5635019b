# find_package(graftal) gives graftal::graftal (docs/library.md).
include(CMakeFindDependencyMacro)
find_dependency(Threads)
find_dependency(fmt)
find_dependency(PNG)
include(${CMAKE_CURRENT_LIST_DIR}/graftalTargets.cmake)
