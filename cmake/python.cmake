# The Python package graftal: runtime/python/graftal, and its module, which knows the library's public face only.
set(PYBIND11_FINDPYTHON ON)
set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "The Python that the package is for")
find_package(Python REQUIRED COMPONENTS Interpreter Development.Module)
find_package(pybind11 REQUIRED)
pybind11_add_module(graftal_python MODULE NO_EXTRAS runtime/python/module.cpp)
target_link_libraries(graftal_python PRIVATE graftal_library)
target_compile_definitions(graftal_python PRIVATE GRAFTAL_VERSION="${PROJECT_VERSION}")
set_target_properties(graftal_python PROPERTIES OUTPUT_NAME _graftal LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/python/graftal
                      BUILD_RPATH "$ORIGIN/../.." INSTALL_RPATH "$ORIGIN/../../../${CMAKE_INSTALL_LIBDIR}"
                      UNITY_BUILD OFF CXX_VISIBILITY_PRESET hidden)
set(package runtime/python/graftal)
configure_file(${package}/__init__.py python/graftal/__init__.py COPYONLY)
set(python_folder lib/python3/dist-packages/graftal)
install(TARGETS graftal_python LIBRARY DESTINATION ${python_folder} COMPONENT python)
install(FILES ${package}/__init__.py ${package}/_graftal.pyi ${package}/py.typed DESTINATION ${python_folder} COMPONENT python)
