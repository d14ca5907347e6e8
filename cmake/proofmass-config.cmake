# find_package(proofmass 0.1 REQUIRED [COMPONENTS shared|static])
#
# shared: proofmass::proofmass, all of it as one library, which asks for Eigen alone.
# static: the modules one by one, proofmass::core, …; what they use privately is linked by whoever uses
# them, so everything that the root CMakeLists.txt finds has to be found here too. tests/install holds
# the two together. Without COMPONENTS they are there where all of that is.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
include(${CMAKE_CURRENT_LIST_DIR}/proofmass-targets.cmake)
set(proofmass_shared_FOUND TRUE)

if(NOT proofmass_FIND_COMPONENTS OR static IN_LIST proofmass_FIND_COMPONENTS)
  list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
  set(proofmass_missing)
  foreach(package IN ITEMS Boost Ceres ZLIB LibLZMA LibZip Lz4 Zstd OpenSSL Threads fmt nlohmann_json tomlplusplus)
    find_package(${package} QUIET)
    if(NOT ${package}_FOUND)
      list(APPEND proofmass_missing ${package})
    endif()
  endforeach()
  foreach(package IN ITEMS Hdf5C Comedi Libiio PahoMqtt) # used if they were there when these were built
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
