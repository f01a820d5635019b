# The one place that says how graftal's libraries and tests are made.

add_library(graftal_flags INTERFACE)
# A batch (CMAKE_UNITY_BUILD) puts the names of one file in the scope of the next: only local names can shadow there.
set(shadow -Wshadow)
if(CMAKE_UNITY_BUILD)
  set(shadow $<IF:$<CXX_COMPILER_ID:GNU>,-Wshadow=local,-Wshadow>)
endif()
# Designated initialisers name what differs from the defaults; g++ warns about every member they leave out.
target_compile_options(graftal_flags INTERFACE -Wall -Wextra -Wpedantic ${shadow} -Wno-missing-field-initializers)
# Tables by kind are switches without default: a kind without a row does not compile.
target_compile_options(graftal_flags INTERFACE -Werror=switch)
# g++ 12 warns falsely about "text" + string (GCC bug 105329).
target_compile_options(graftal_flags INTERFACE
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-stringop-overflow;-Wno-array-bounds>)
# The growth by inlining that GCC allows is a share of the batch: with the usual share it stops before the last files, which
# took 6 % more instructions of `compile scenes/hart/elm.inst`.
if(CMAKE_UNITY_BUILD)
  target_compile_options(graftal_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:--param=inline-unit-growth=200>)
endif()
# A broken invariant names its source by the path from here; no installed file knows where it was built.
target_compile_options(graftal_flags INTERFACE -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
if(GRAFTAL_SANITIZE)
  add_compile_options(-fsanitize=${GRAFTAL_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${GRAFTAL_SANITIZE})
  # The address sanitizer calls dlopen for the program, whose RUNPATH does not count then; its RPATH does.
  add_link_options(-Wl,--disable-new-dtags)
endif()

# Headers that most sources include, compiled once for the layers and once, with GoogleTest's, for the tests. It is a
# clean build's time that they are for: each source still includes what it uses.
function(graftal_precompiled name)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${name}.cpp CONTENT "")
  add_library(${name} OBJECT ${PROJECT_BINARY_DIR}/${name}.cpp)
  target_precompile_headers(${name} PRIVATE <algorithm> <functional> <map> <memory> <optional> <sstream> <string>
                            <unordered_map> <variant> <vector> <glm/glm.hpp> <fmt/format.h> ${ARGN})
  target_link_libraries(${name} PRIVATE glm::glm fmt::fmt graftal_flags)
endfunction()
graftal_precompiled(graftal_headers)

# What goes into programs and into the shared library alike, which shows its public face only.
function(graftal_hidden target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                        VISIBILITY_INLINES_HIDDEN ON)
endfunction()
graftal_hidden(graftal_headers)

# graftal_targets(RESULT folder...): the libraries of the layers in these folders; compiler/graph's is
# graftal_compiler_graph.
function(graftal_targets result)
  list(TRANSFORM ARGN REPLACE "/" "_")
  list(TRANSFORM ARGN PREPEND graftal_)
  set(${result} ${ARGN} PARENT_SCOPE)
endfunction()

# graftal_layer(FOLDER [USES folder...] [LINK target...] [PRIVATE_LINK target...] [WITHOUT folder|folder...])
# makes a library from the sources of FOLDER, its sub-rooms included, apart from those in the
# folders FOLDER/folder.
function(graftal_layer folder)
  cmake_parse_arguments(arg "" "WITHOUT" "USES;LINK;PRIVATE_LINK" ${ARGN})
  graftal_targets(name ${folder})
  graftal_targets(layers ${arg_USES})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
  if(arg_WITHOUT)
    list(FILTER sources EXCLUDE REGEX "/${folder}/(${arg_WITHOUT})/")
  endif()
  add_library(${name} STATIC ${sources})
  set_property(GLOBAL APPEND PROPERTY GRAFTAL_LAYERS ${name})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PUBLIC ${layers} ${arg_LINK} PRIVATE ${arg_PRIVATE_LINK} graftal_flags)
  graftal_hidden(${name})
  target_precompile_headers(${name} REUSE_FROM graftal_headers)
endfunction()

# graftal_kernel(LAYER FILE.comp [NAME DEFINITION]): what GPUs run of a layer, as an array NAME_spirv in the header
# NAME_spirv.h; NAME is FILE unless it is given.
function(graftal_kernel folder kernel)
  graftal_targets(layer ${folder})
  get_filename_component(name ${kernel} NAME_WE)
  if(ARGC GREATER 2)
    set(name ${ARGV2})
  endif()
  set(header ${PROJECT_BINARY_DIR}/kernels/${folder}/${name}_spirv.h)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/kernels/${folder})
  file(GLOB_RECURSE texts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/*/*.glsl)
  add_custom_command(OUTPUT ${header} VERBATIM
    COMMAND ${GRAFTAL_GLSLANG} --quiet --target-env vulkan1.2 -S comp -I${PROJECT_SOURCE_DIR} ${ARGV3} --vn ${name}_spirv
            -o ${header} ${PROJECT_SOURCE_DIR}/${kernel}
    DEPENDS ${PROJECT_SOURCE_DIR}/${kernel} ${texts})
  if(NOT TARGET graftal_kernels) # which tools/tidy makes, too
    add_custom_target(graftal_kernels)
  endif()
  add_custom_target(graftal_kernel_${name} DEPENDS ${header})
  add_dependencies(graftal_kernels graftal_kernel_${name})
  target_sources(${layer} PRIVATE ${header})
  target_include_directories(${layer} PRIVATE ${PROJECT_BINARY_DIR}/kernels)
endfunction()

# graftal_test(FOLDER USES folder...): one GoogleTest program from the sources of tests/FOLDER, its sub-rooms included. The
# label of its tests is the first folder of FOLDER: `ctest -L unit` is the inner loop.
function(graftal_test folder)
  cmake_parse_arguments(arg "" "" "USES;LINK" ${ARGN})
  string(REPLACE "/" "_" name ${folder})
  string(REGEX REPLACE "/.*" "" label ${folder})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${folder}/*.cpp)
  graftal_targets(layers ${arg_USES})
  add_executable(${name}_test ${sources})
  target_link_libraries(${name}_test PRIVATE ${layers} ${arg_LINK} graftal_flags GTest::gmock GTest::gtest_main)
  target_precompile_headers(${name}_test REUSE_FROM graftal_test_headers)
  target_compile_definitions(${name}_test PRIVATE GRAFTAL_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  if(label STREQUAL unit)
    add_dependencies(unit_tests ${name}_test)
  endif()
  gtest_discover_tests(${name}_test TEST_PREFIX ${folder}/ PROPERTIES LABELS ${label} TIMEOUT 300 DISCOVERY_TIMEOUT 60)
endfunction()
