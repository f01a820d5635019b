# The core alone, for targets without an operating system (emcmake): its libraries are headers in one folder.
foreach(library fmt::fmt glm::glm Eigen3::Eigen Boost::headers nlohmann_json::nlohmann_json)
  add_library(${library} INTERFACE IMPORTED)
  target_include_directories(${library} SYSTEM INTERFACE ${GRAFTAL_CORE_HEADERS})
endforeach()
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
# libc++ has dropped a base class of C++98 that Boost before 1.81 names.
target_compile_definitions(Boost::headers INTERFACE BOOST_NO_CXX98_FUNCTION_BASE)
