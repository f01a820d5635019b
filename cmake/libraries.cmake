# The libraries that graftal stands on, as the system has them.
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(glm REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(Boost REQUIRED)
# By pkg-config: the CMake files of the Debian package ask for its tools and Python module too.
find_package(PkgConfig REQUIRED)
pkg_check_modules(OpenImageIO REQUIRED IMPORTED_TARGET OpenImageIO)
find_package(OpenEXR REQUIRED)
find_package(PNG REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(TinyGLTF REQUIRED)
find_package(ZLIB REQUIRED)
find_package(pugixml REQUIRED)
# Vulkan's loader is found at run time, if there is one: programs need its headers alone, and the compiler of its kernels.
find_path(GRAFTAL_VULKAN_HEADERS vulkan/vulkan_core.h REQUIRED)
find_program(GRAFTAL_GLSLANG glslangValidator REQUIRED)
