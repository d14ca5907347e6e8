# The libraries are static, so what they use privately is linked by whoever uses them: everything
# that the root CMakeLists.txt finds has to be found here too. tests/install holds the two together.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(Boost 1.74)
find_dependency(Ceres)
find_dependency(ZLIB)
find_dependency(LibLZMA)
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
find_dependency(LibZip)
find_dependency(Lz4)
find_dependency(Zstd)
find_package(Hdf5C QUIET) # used if it was there when these were built
find_dependency(fmt)
find_dependency(nlohmann_json)
find_dependency(tomlplusplus)
include(${CMAKE_CURRENT_LIST_DIR}/proofmass-targets.cmake)
