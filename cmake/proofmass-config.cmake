# find_package(proofmass 0.1 REQUIRED [COMPONENTS shared|static])
#
# shared: proofmass::proofmass, everything in one library, which requires Eigen only.
# static: the modules separately, proofmass::core, …; their private dependencies are linked by their
# users, so everything that the root CMakeLists.txt finds has to be found here too. tests/install
# checks that the two agree. Without COMPONENTS they are available if all dependencies are.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
include(${CMAKE_CURRENT_LIST_DIR}/proofmass-targets.cmake)
set(proofmass_shared_FOUND TRUE)

if(NOT proofmass_FIND_COMPONENTS OR static IN_LIST proofmass_FIND_COMPONENTS)
  list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
  set(proofmass_missing)
  include(${CMAKE_CURRENT_LIST_DIR}/ProofmassPackages.cmake)
  foreach(package IN ITEMS Boost ZLIB LibLZMA LibZip Lz4 Zstd Deflate OpenSSL Threads fmt nlohmann_json tomlplusplus)
    if(NOT ${package}_FOUND)
      find_package(${package} QUIET)
    endif()
    if(NOT ${package}_FOUND)
      list(APPEND proofmass_missing ${package})
    endif()
  endforeach()
  foreach(package IN ITEMS Hdf5C eclipse-paho-mqtt-c) # used if available at build time
    find_package(${package} QUIET)
  endforeach()
  list(POP_BACK CMAKE_MODULE_PATH)
  if(proofmass_missing)
    list(JOIN proofmass_missing ", " proofmass_missing)
    set(proofmass_NOT_FOUND_MESSAGE "the static libraries need ${proofmass_missing}")
    if(NOT proofmass_FIND_COMPONENTS AND NOT proofmass_FIND_QUIETLY)
      message(STATUS "proofmass: proofmass::proofmass alone; ${proofmass_NOT_FOUND_MESSAGE}")
    endif()
  else()
    include(${CMAKE_CURRENT_LIST_DIR}/proofmass-static-targets.cmake)
    set(proofmass_static_FOUND TRUE)
  endif()
endif()

foreach(component IN LISTS proofmass_FIND_COMPONENTS)
  if(proofmass_FIND_REQUIRED_${component} AND NOT proofmass_${component}_FOUND)
    set(proofmass_FOUND FALSE)
  endif()
endforeach()
