# Debian packages by CPack; tools/package builds and checks them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME graftal)
set(CPACK_PACKAGE_VENDOR "The graftal authors")
set(CPACK_PACKAGE_CONTACT "The graftal authors <graftal@graftal.org>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program library development documentation)
if(GRAFTAL_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_DEBUGINFO_PACKAGE OFF)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package_files.cmake)

# graftal_package(COMPONENT NAME SECTION SUMMARY DESCRIPTION [depends])
macro(graftal_package component name section summary description)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${summary}\n${description}")
  string(REPLACE ";" ", " depends "${ARGN}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}")
endmacro()

set(about "graftal compiles small text models (parametric L-systems, recurrent
iterated function systems, objects made of instances of objects) into pictures
of enormous things, and into scenes for POV-Ray.")
if(GRAFTAL_PYTHON)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
endif()
set(same "(= ${PROJECT_VERSION})")
graftal_package(program graftal graphics "pictures of fractals and plants from small models"
                "${about}" "libgraftal1 ${same}")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "povray, ffmpeg")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "graftal-doc")
graftal_package(library libgraftal1 libs "pictures of fractals and plants: shared library"
                "${about}\n.\nThis package has the shared library, and its reader and writer of picture\nfiles.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/triggers;${PROJECT_BINARY_DIR}/shlibs")
file(CONFIGURE OUTPUT shlibs CONTENT "libgraftal 1 libgraftal1 (>= @PROJECT_VERSION@)\n" @ONLY)
graftal_package(development libgraftal-dev libdevel "pictures of fractals and plants: headers of the library"
                "${about}\n.\nThis package has the headers, and the files for CMake's find_package(graftal)."
                "libgraftal1 ${same}")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
graftal_package(python python3-graftal python "pictures of fractals and plants: Python package"
                "${about}\n.\nThis package has the module for Python 3: pictures and points as NumPy arrays."
                "libgraftal1 ${same}" "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR})"
                "python3 (<< ${Python_VERSION_MAJOR}.${next_minor})" python3-numpy)
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/prerm)
graftal_package(documentation graftal-doc doc "pictures of fractals and plants: documentation and scenes"
                "${about}\n.\nThis package has the documentation with its gallery, and the scenes.")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SHLIBDEPS OFF)

install(DIRECTORY docs scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/graftal-doc COMPONENT documentation)
include(CPack)
